// Buttons, keys, pointers and wheel of the player.
const onPointers = (player) => {
  const { canvas, camera } = player;
  const pointers = new Map();
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  const place = (event) => ({ x: event.offsetX, y: event.offsetY });
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, place(event));
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const wide = pointers.size === 2 ? spread() : 0;
    const now = place(event);
    pointers.set(event.pointerId, now);
    if (pointers.size === 2) zoomCamera(camera, spread() / Math.max(1, wide), now.x, now.y);
    else {
      setFollow(player, false);
      panCamera(camera, now.x - before.x, now.y - before.y);
    }
    requestDraw(player);
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
  }
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoomCamera(camera, Math.exp(-event.deltaY / 400), event.offsetX, event.offsetY);
    requestDraw(player);
  }, { passive: false });
  canvas.addEventListener("dblclick", () => showAll(player));
};

const nextClosing = (player, direction) => {
  const k = scanAt(player) + player.drive.firstStep;
  const steps = player.closings.map((closing) => closing.step).filter((step) => (step - k) * direction > 0);
  if (steps.length > 0) player.goTo(direction > 0 ? steps[0] : last(steps));
};

const keysOf = (player) => ({
  " ": () => setPlaying(player, !player.playing),
  ArrowLeft: (event) => stepBy(player, event.shiftKey ? -25 : -1),
  ArrowRight: (event) => stepBy(player, event.shiftKey ? 25 : 1),
  ArrowUp: () => nextClosing(player, -1),
  ArrowDown: () => nextClosing(player, 1),
  "+": () => changeSpeed(player, 1),
  "=": () => changeSpeed(player, 1),
  "-": () => changeSpeed(player, -1),
  Home: () => setTime(player, 0),
  End: () => setTime(player, player.end),
  f: () => setFollow(player, !player.follow),
});

// Keys are the player's while the focus is in it. While nothing has the focus and the picture is in view, so are those that do not
// scroll a page up and down.
const scrolling_keys = ["ArrowUp", "ArrowDown", "Home", "End"];

const isInView = (node) => {
  const { top, bottom } = node.getBoundingClientRect();
  return bottom > 0 && top < window.innerHeight;
};

const onKeys = (player) => {
  const keys = keysOf(player);
  document.addEventListener("keydown", (event) => {
    const inside = byId("player").contains(document.activeElement);
    const nowhere = document.activeElement === document.body && !scrolling_keys.includes(event.key) && isInView(player.canvas);
    if (event.ctrlKey || event.altKey || event.metaKey || !(inside || nowhere)) return;
    const typed = document.activeElement.tagName;
    if (typed === "SELECT" || ((typed === "BUTTON" || typed === "INPUT") && event.key === " " && document.activeElement.id !== "player-time")) return;
    const key = keys[event.key];
    if (!key) return;
    event.preventDefault();
    key(event);
  });
};

const onButtons = (player) => {
  byId("player-play").addEventListener("click", () => setPlaying(player, !player.playing));
  byId("player-back").addEventListener("click", () => stepBy(player, -1));
  byId("player-on").addEventListener("click", () => stepBy(player, 1));
  byId("player-all").addEventListener("click", () => showAll(player));
  byId("player-save").addEventListener("click", () => savePicture(player));
  byId("player-speed").addEventListener("change", (event) => setSpeed(player, Number(event.target.value)));
  byId("player-follow").addEventListener("change", (event) => setFollow(player, event.target.checked));
  byId("player-time").addEventListener("input", (event) => setTime(player, Number(event.target.value) / 1000));
  byId("player-strip").addEventListener("click", (event) =>
    setTime(player, player.end * event.offsetX / byId("player-strip").clientWidth));
  for (const name of Object.keys(player.show)) {
    const box = byId(`player-${name}`);
    box.checked = player.show[name];
    box.parentElement.hidden = (name === "truth" && !player.drive.truth) || (name === "final" && !player.drive.final);
    box.addEventListener("change", () => {
      player.show[name] = box.checked;
      requestDraw(player);
    });
  }
};

// The whole drive in a minute and a half, more or less.
const startSpeed = (seconds) => speeds.reduce((best, speed) => (speed <= seconds / 90 ? speed : best), 1);

const startPlayer = () => {
  const drive = theDrive();
  byId("player-section").hidden = !drive || !filtered;
  if (!drive || !filtered) return;
  const player = makePlayer(drive);
  player.canvas = byId("player-canvas");
  player.context = player.canvas.getContext("2d", { alpha: false });
  player.said = decisionsByStep(player.drive);
  player.goTo = (step) => {
    const k = Math.min(player.drive.count - 1, Math.max(0, step - player.drive.firstStep));
    setPlaying(player, false);
    setTime(player, player.drive.t[k]);
    setFollow(player, true);
  };
  goToStep = (step) => {
    player.goTo(step);
    byId("player").scrollIntoView({ block: "center" });
    player.canvas.focus({ preventScroll: true });
  };
  byId("player-time").max = Math.round(1000 * player.end);
  byId("player-speed").append(...speeds.map((speed) => new Option(`× ${speed}`, speed)));
  onButtons(player);
  onPointers(player);
  onKeys(player);
  setSpeed(player, startSpeed(player.end));
  new ResizeObserver(() => fitCanvas(player)).observe(player.canvas);
  dark.addEventListener("change", () => fitCanvas(player));
  window.helixnavPlayer = player;  // for whoever looks from the console, and for the test
};
