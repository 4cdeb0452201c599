// The sentences that the page opens with. A closing is a row with a mark, and so is where the vehicle was carried or found its place;
// a click on it shows it in the player.
const marks = { accepted: "✓", refused: "✗", undecided: "○", "new-ground": "◇", told: "↷", "found-out": "↷", "broken-off": "↷", "by-place": "↷", "no-odometry": "↷", "wrong-start": "↷", "wrong-place": "↷" };

const errorText = (closure) => {
  if (!known(closure.error_before_m) || !known(closure.error_after_m)) return "";
  return `Position error ${metres(closure.error_before_m)} before it, ${metres(closure.error_after_m)} after it.`;
};

// A vehicle that finds no place asks again and again: closings refused, or left undecided, one after the other are one row.
const grouped = (closures) => {
  const groups = [];
  for (const closure of closures) {
    const group = last(groups);
    const repeated = group && closure.kind === "closure" && closure.verdict !== "accepted";
    if (repeated && group[0].verdict === closure.verdict) group.push(closure);
    else groups.push([closure]);
  }
  return groups;
};

const repeatedText = (group) => (group.length === 1 ? ""
  : `${group.length} times in a row until step ${count(last(group).step)}; the first time: `);

const closingRow = (group) => {
  const [closure] = group;
  const row = element("button", undefined, `closing ${closure.verdict}`);
  row.type = "button";
  const words = element("span");
  words.append(element("b", `${duration(closure.t - data.begin_s)} into the drive, step ${count(closure.step)}. `),
               repeatedText(group), closure.sentence, " ", element("em", errorText(closure)));
  row.append(element("span", marks[closure.verdict] || "·", "mark"), words);
  row.addEventListener("click", () => goToStep(closure.step));
  return row;
};

const writeClosings = (closures) => {
  const most = 8;
  const box = byId("closings");
  const groups = grouped(closures);
  box.append(...groups.slice(0, most).map(closingRow));
  if (groups.length <= most) return;
  const more = element("button", `Show the other ${count(groups.length - most)}`, "plain");
  more.type = "button";
  more.addEventListener("click", () => more.replaceWith(...groups.slice(most).map(closingRow)));
  box.append(more);
};

const writeOpening = () => {
  byId("opening").append(...data.opening.warnings.map((text) => element("p", `${text}.`, "warning")),
                         ...data.opening.sentences.map((text) => element("p", text)));
  const placed = ({ kind, verdict }) => kind === "carried" || (kind === "placed" && verdict === "accepted");
  writeClosings(data.decisions.filter((decision) => decision.kind === "closure" || placed(decision)));
};
