// The text beside the picture. While the player plays it changes as often as it can be read, not with every frame.
const milliseconds_of_text = 120;

const scanText = ({ drive }, k) => {
  const { scans } = drive;
  const scan = Math.floor(k / scans.stride);
  const counts = [0, 0, 0, 0];
  for (let i = scans.offsets[scan]; i < scans.offsets[scan + 1]; i++) counts[scans.outcome[i]]++;
  const names = ["matched", "new", "ambiguous", "rejected"];
  const parts = counts.map((number, i) => (number > 0 ? `${number} ${names[i]}` : "")).filter((part) => part);
  return parts.length > 0 ? `seen: ${parts.join(", ")}` : "nothing seen";
};

// To the centimetre: places are packed in centimetres.
const errorNow = ({ drive, t }, k) => {
  const truth = drive.truth && !drive.truth.aligned && truthAt(drive.truth, drive.t[k]);
  return truth ? `, error ${fixed(Math.hypot(drive.x[k] - truth[0], drive.y[k] - truth[1]), 2)} m` : "";
};

const setText = (id, text) => {
  const node = byId(id);
  if (node.textContent !== text) node.textContent = text;
};

const writeState = (player) => {
  const now = performance.now();
  if (player.playing && now - player.wrote < milliseconds_of_text) return;
  player.wrote = now;
  const { drive, t, end, k } = player;
  const searching = searchingAt(drive, k);
  byId("player-time").value = Math.round(1000 * t);
  setText("player-clock", `${fixed(t, 1)} / ${fixed(end, 1)} s`);
  setText("player-mode", searching ? "searching" : "mapping");
  byId("player-mode").classList.toggle("searching", searching);
  setText("player-state", `step ${count(k + drive.firstStep)}, ${scanText(player, k)}${errorNow(player, k)}`);
  const said = player.said(k);
  setText("player-said", said ? `Step ${count(said.step)}: ${said.sentence}` : "");
};

// What was decided last at or before a scan: {step, sentence}.
const decisionsByStep = (drive) => {
  const said = [];
  for (const { step, sentence } of [...data.decisions].sort((a, b) => a.step - b.step)) {
    if (said.length > 0 && last(said).step === step) last(said).sentence += ` ${sentence}`;
    else said.push({ step, sentence });
  }
  const steps = said.map((one) => one.step - drive.firstStep);
  return (k) => said[lastAtMost(steps, k)];
};
