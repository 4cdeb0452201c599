// Closures and other decisions as tables.
const showInPlayer = (step) => {
  const button = element("button", count(step), "link");
  button.type = "button";
  button.title = "show in the player";
  button.addEventListener("click", () => goToStep(step));
  return button;
};

const decisionTable = (decisions, most) => {
  const box = element("table");
  const head = element("tr");
  for (const name of ["step", "time [s]", "decision", "verdict", "numbers"]) head.append(element("th", name));
  box.append(head);
  for (const decision of decisions.slice(0, most)) {
    const row = element("tr");
    const numbers = decision.numbers.map(([name, value]) =>
      `${name} = ${known(value) ? +value.toPrecision(5) : "–"}`);
    const state = decision.verdict === "accepted" ? "accepted" : decision.verdict === "refused" ? "refused" : "";
    const step = element("td");
    step.append(showInPlayer(decision.step));
    row.append(step, element("td", fixed(decision.t, 2)), element("td", decision.kind),
               element("td", decision.verdict, state), element("td", numbers.join(", "), "numbers"));
    box.append(row);
  }
  return box;
};

const writeDecisions = () => {
  const closures = data.decisions.filter((decision) => decision.kind === "closure");
  const others = data.decisions.filter((decision) => decision.kind !== "closure");
  byId("closures").append(closures.length > 0 ? decisionTable(closures, closures.length)
                                              : element("p", "No loop was closed or refused in this run.", "quiet"));
  if (others.length === 0 && data.decisions_left_out === 0) {
    byId("decisions").append(element("p", "None.", "quiet"));
    return;
  }
  const details = element("details");
  const left = data.decisions_left_out > 0 ? `; ${count(data.decisions_left_out)} more in decisions.csv` : "";
  details.append(element("summary", `${count(others.length)} decisions${left}`),
                 decisionTable(others, others.length));
  byId("decisions").append(details);
};
