// The player: time goes on or is set, and the scene is drawn at that time.
let goToStep = () => {};

const speeds = [.25, .5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

const makePlayer = (drive) => {
  const closings = data.decisions.filter((decision) => decision.kind === "closure");
  const leaps = closings.filter((closing) => closing.verdict === "accepted")
    .map((closing) => closing.step - drive.firstStep).filter((k) => k > 0);
  const line_ = (path) => path && makePolyline(path.x, path.y);
  return {
    drive, closings, leaps, stretches: stretchesOf(drive, leaps),
    lines: { path: line_(drive), final: line_(drive.final), truth: line_(drive.truth) },
    layers: { ground: makeLayer(), trail: makeLayer() },
    camera: makeCamera(), show: { truth: true, final: false, ids: false }, follow: false, playing: false,
    t: 0, end: drive.t[drive.count - 1], speed: 1,
  };
};

// Scan at the time of the player, and the pose there: between two scans on the line between them, unless that is a leap.
const scanAt = ({ drive, t }) => Math.max(0, lastAtMost(drive.t, t + 1e-6));
const poseAt = ({ drive, t }, k) => {
  const pose = { x: drive.x[k], y: drive.y[k], heading: drive.heading[k] };
  if (k + 1 >= drive.count || drive.t[k + 1] <= drive.t[k]) return pose;
  const part = Math.min(1, Math.max(0, (t - drive.t[k]) / (drive.t[k + 1] - drive.t[k])));
  const dx = drive.x[k + 1] - pose.x, dy = drive.y[k + 1] - pose.y;
  const before = k > 0 ? Math.hypot(pose.x - drive.x[k - 1], pose.y - drive.y[k - 1]) : Infinity;
  if (part === 0 || Math.hypot(dx, dy) > 3 * before + .5) return pose;
  return { x: pose.x + part * dx, y: pose.y + part * dy,
           heading: pose.heading + part * (drive.heading[k + 1] - pose.heading) };
};

const drawPlayer = (player) => {
  const k = scanAt(player);
  const pose = poseAt(player, k);
  if (player.follow) [player.camera.x, player.camera.y] = [pose.x, pose.y];
  drawScene({ ...player, context: player.context, palette: c, k, pose });
  writeState(player, k);
};

// --- text beside the picture ---------------------------------------------------------------------------------------------
const scanText = ({ drive }, k) => {
  const { scans } = drive;
  const scan = Math.floor(k / scans.stride);
  const counts = [0, 0, 0, 0];
  for (let i = scans.offsets[scan]; i < scans.offsets[scan + 1]; i++) counts[scans.outcome[i]]++;
  const names = ["matched", "new", "ambiguous", "rejected"];
  const parts = counts.map((number, i) => (number > 0 ? `${number} ${names[i]}` : "")).filter((part) => part);
  return parts.length > 0 ? `seen: ${parts.join(", ")}` : "nothing seen";
};

const errorNow = ({ drive, t }, k) => {
  const truth = drive.truth && !drive.truth.aligned && truthAt(drive.truth, drive.t[k]);
  return truth ? `, error ${metres(Math.hypot(drive.x[k] - truth[0], drive.y[k] - truth[1]))}` : "";
};

const writeState = (player, k) => {
  const { drive, t, end } = player;
  const searching = searchingAt(drive, k);
  byId("player-time").value = Math.round(1000 * t);
  byId("player-clock").textContent = `${fixed(t, 1)} / ${fixed(end, 1)} s`;
  byId("player-mode").textContent = searching ? "searching" : "mapping";
  byId("player-mode").className = searching ? "mode searching" : "mode";
  byId("player-state").textContent =
    `step ${count(k + drive.firstStep)}, ${scanText(player, k)}${errorNow(player, k)}`;
  const said = player.said(k);
  byId("player-said").textContent = said ? `Step ${count(said.step)}: ${said.sentence}` : "";
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

// --- time ----------------------------------------------------------------------------------------------------------------
const setTime = (player, t) => {
  player.t = Math.min(player.end, Math.max(0, t));
  if (player.t >= player.end) setPlaying(player, false);
  requestDraw(player);
};

const requestDraw = (player) => {
  if (player.requested) return;
  player.requested = true;
  requestAnimationFrame((now) => onFrame(player, now));
};

const onFrame = (player, now) => {
  player.requested = false;
  if (player.playing) {
    const passed = player.before === undefined ? 0 : Math.min(.1, (now - player.before) / 1000);
    player.before = now;
    player.t = Math.min(player.end, player.t + passed * player.speed);
    if (player.t >= player.end) setPlaying(player, false);
    else requestDraw(player);
  }
  drawPlayer(player);
};

const setPlaying = (player, playing) => {
  if (playing && player.t >= player.end) player.t = 0;
  player.playing = playing;
  player.before = undefined;
  byId("player-play").textContent = playing ? "❚❚ Pause" : "▶ Play";
  if (playing) requestDraw(player);
};

const stepBy = (player, scans) => {
  setPlaying(player, false);
  const k = Math.min(player.drive.count - 1, Math.max(0, scanAt(player) + scans));
  setTime(player, player.drive.t[k]);
};

const setSpeed = (player, speed) => {
  player.speed = speed;
  byId("player-speed").value = String(speed);
};

const changeSpeed = (player, by) => {
  const i = speeds.indexOf(player.speed) + by;
  if (i >= 0 && i < speeds.length) setSpeed(player, speeds[i]);
};

// --- what is shown -------------------------------------------------------------------------------------------------------
const farthestSeen = ({ scans }) => {
  const ranges = [];
  const every = Math.max(1, Math.floor(scans.x.length / 2000));
  for (let i = 0; i < scans.x.length; i += every) {
    const range = Math.hypot(scans.x[i], scans.y[i]);
    if (Number.isFinite(range)) ranges.push(range);
  }
  ranges.sort((a, b) => a - b);
  return ranges.length > 0 ? ranges[Math.floor(.95 * (ranges.length - 1))] : 30;
};

const setFollow = (player, follow) => {
  player.follow = follow;
  byId("player-follow").checked = follow;
  if (follow) {
    const { camera } = player;
    camera.scale = Math.max(camera.scale, Math.min(camera.width, camera.height) / (2.6 * farthestSeen(player.drive)));
  }
  requestDraw(player);
};

const showAll = (player) => {
  setFollow(player, false);
  fitCamera(player.camera, data.map_extent);
  requestDraw(player);
};

const fitCanvas = (player) => {
  const { canvas, camera } = player;
  const ratio = window.devicePixelRatio || 1;
  const first = camera.width === 1;
  camera.width = canvas.clientWidth;
  camera.height = canvas.clientHeight;
  canvas.width = Math.round(camera.width * ratio);
  canvas.height = Math.round(camera.height * ratio);
  player.context.setTransform(ratio, 0, 0, ratio, 0, 0);
  if (first) fitCamera(camera, data.map_extent);
  drawStrip(player);
  requestDraw(player);
};

// The drive as a strip of time: searches, and ticks where closings were accepted or refused.
const drawStrip = ({ drive, end, closings }) => {
  const strip = byId("player-strip");
  const ratio = window.devicePixelRatio || 1;
  strip.width = Math.round(strip.clientWidth * ratio);
  strip.height = Math.round(strip.clientHeight * ratio);
  const context = strip.getContext("2d");
  const x = (t) => (end > 0 ? t / end : 0) * strip.width;
  context.fillStyle = c.band;
  context.fillRect(0, 0, strip.width, strip.height);
  context.fillStyle = c.other;
  drive.modes.forEach(([from, mode], i) => {
    const to = i + 1 < drive.modes.length ? drive.modes[i + 1][0] : drive.count - 1;
    if (mode === 1) context.fillRect(x(drive.t[from]), .55 * strip.height, Math.max(1, x(drive.t[to] - drive.t[from])), strip.height);
  });
  for (const closing of closings) {
    context.fillStyle = closing.verdict === "accepted" ? c.landmark : closing.verdict === "refused" ? c.bad : c.faint;
    context.fillRect(x(drive.t[closing.step - drive.firstStep]) - ratio, 0, 2 * ratio, .55 * strip.height);
  }
};

const savePicture = (player) => {
  drawPlayer(player);
  player.canvas.toBlob((blob) => {
    const link = element("a");
    link.href = URL.createObjectURL(blob);
    link.download = `helixnav-step-${scanAt(player) + player.drive.firstStep}.png`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
};
