// The player: time goes on or is set, and the scene is drawn at that time.
let goToStep = () => {};

const speeds = [.25, .5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

const makePlayer = (drive) => {
  const closings = data.decisions.filter((decision) => decision.kind === "closure");
  const leaps = Int32Array.from(closings.filter((closing) => closing.verdict === "accepted")
    .map((closing) => closing.step - drive.firstStep).filter((k) => k > 0));
  const line_ = (path) => path && makePolyline(path.x, path.y);
  return {
    drive, closings, leaps, stretches: stretchesOf(drive, leaps),
    lines: { path: line_(drive), final: line_(drive.final), truth: line_(drive.truth) },
    present: makePresent(drive.landmarks), visible: new Int32Array(drive.landmarks.id.length),
    ground: makeLayer(), trail: makeLayer(), ink: makeInk(), cells: makeCells(),
    camera: makeCamera(), fitted: false, show: { truth: true, final: false, ids: false }, follow: false, playing: false,
    t: 0, end: drive.t[drive.count - 1], speed: 1, k: 0, pose: { x: 0, y: 0, heading: 0 }, palette: c,
  };
};

// Scan at the time of the player, and the pose there: between two scans on the line between them, unless that is a leap.
const scanAt = ({ drive, t }) => Math.max(0, lastAtMost(drive.t, t + 1e-6));
const setPose = ({ drive, t, k, pose }) => {
  pose.x = drive.x[k];
  pose.y = drive.y[k];
  pose.heading = drive.heading[k];
  if (k + 1 >= drive.count || drive.t[k + 1] <= drive.t[k]) return;
  const part = Math.min(1, Math.max(0, (t - drive.t[k]) / (drive.t[k + 1] - drive.t[k])));
  const dx = drive.x[k + 1] - pose.x, dy = drive.y[k + 1] - pose.y;
  const before = k > 0 ? Math.hypot(pose.x - drive.x[k - 1], pose.y - drive.y[k - 1]) : Infinity;
  if (part === 0 || Math.hypot(dx, dy) > 3 * before + .5) return;
  pose.x += part * dx;
  pose.y += part * dy;
  pose.heading += part * (drive.heading[k + 1] - pose.heading);
};

const drawPlayer = (player) => {
  if (!player.fitted) return;
  player.k = scanAt(player);
  player.palette = c;
  setPose(player);
  if (player.follow) [player.camera.x, player.camera.y] = [player.pose.x, player.pose.y];
  drawScene(player);
  writeState(player);
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
  requestDraw(player);
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
  if (canvas.clientWidth === 0 || canvas.clientHeight === 0) return;  // hidden, as in a frame that is not shown
  const ratio = Math.min(2, window.devicePixelRatio || 1);  // more costs a phone time and shows nothing
  camera.width = canvas.clientWidth;
  camera.height = canvas.clientHeight;
  canvas.width = Math.round(camera.width * ratio);
  canvas.height = Math.round(camera.height * ratio);
  player.context.setTransform(ratio, 0, 0, ratio, 0, 0);
  if (!player.fitted) fitCamera(camera, data.map_extent);
  player.fitted = true;
  drawStrip(player);
  requestDraw(player);
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
