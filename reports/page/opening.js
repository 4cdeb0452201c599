// The sentences that the page opens with; a closing is a row with a mark, and a click on it shows it in the player.
const marks = { accepted: "✓", refused: "✗", undecided: "○" };

const errorText = (closure) => {
  if (!known(closure.error_before_m) || !known(closure.error_after_m)) return "";
  return `Position error ${metres(closure.error_before_m)} before it, ${metres(closure.error_after_m)} after it.`;
};

const closingRow = (closure) => {
  const row = element("button", undefined, `closing ${closure.verdict}`);
  row.type = "button";
  const words = element("span");
  words.append(element("b", `${duration(closure.t - data.begin_s)} into the drive, step ${count(closure.step)}. `),
               closure.sentence, " ", element("em", errorText(closure)));
  row.append(element("span", marks[closure.verdict] || "·", "mark"), words);
  row.addEventListener("click", () => goToStep(closure.step));
  return row;
};

const writeClosings = (closures) => {
  const most = 8;
  const box = byId("closings");
  box.append(...closures.slice(0, most).map(closingRow));
  if (closures.length <= most) return;
  const more = element("button", `Show all ${count(closures.length)}`, "plain");
  more.type = "button";
  more.addEventListener("click", () => more.replaceWith(...closures.slice(most).map(closingRow)));
  box.append(more);
};

const writeOpening = () => {
  byId("opening").append(...data.opening.warnings.map((text) => element("p", `${text}.`, "warning")),
                         ...data.opening.sentences.map((text) => element("p", text)));
  writeClosings(data.decisions.filter((decision) => decision.kind === "closure"));
};
