// Pictures of each closure.
const onto = ([x, y, h], [px, py]) =>
  [x + Math.cos(h) * px - Math.sin(h) * py, y + Math.sin(h) * px + Math.cos(h) * py];
const seenFrom = ([x, y, h], [px, py]) =>
  [Math.cos(h) * (px - x) + Math.sin(h) * (py - y), -Math.sin(h) * (px - x) + Math.cos(h) * (py - y)];

// A stroke in the direction of travel from every pose, all in one line with gaps.
const strokes = (poses, length_m) => ({
  x: poses.flatMap(([x, , h]) => [x, x + length_m * Math.cos(h), null]),
  y: poses.flatMap(([, y, h]) => [y, y + length_m * Math.sin(h), null]),
});
const arrow = (name, pose, length_m, colour) => {
  const s = strokes([pose], length_m);
  return [
    line(name, s.x, s.y, colour, { line: { color: colour, width: 3 }, hoverinfo: "skip", showlegend: false }),
    dots(name, [pose[0]], [pose[1]], colour, { marker: { color: colour, size: 9, line: { color: c.paper, width: 1 } },
      hovertemplate: `%{x:.2f}, %{y:.2f} m<extra>${name}</extra>` }),
  ];
};
// Landmarks of a constellation, with lines to the vehicle that sees them.
const constellation = (name, pose, points, colour, symbol) => [
  line(name, points.flatMap((p) => [pose[0], p[0], null]), points.flatMap((p) => [pose[1], p[1], null]), colour,
    { line: { color: colour, width: .8 }, opacity: .6, hoverinfo: "skip", showlegend: false }),
  dots(name, points.map((p) => p[0]), points.map((p) => p[1]), colour,
    { marker: { color: colour, size: 10, symbol, line: { color: colour, width: 2 } } }),
];

const squareAround = (points) => [0, 1].map((axis_, _, both) => {
  const low = (k) => Math.min(...points.map((p) => p[k]));
  const high = (k) => Math.max(...points.map((p) => p[k]));
  const half = 8 + Math.max(...both.map((k) => high(k) - low(k))) / 2;
  const middle = (low(axis_) + high(axis_)) / 2;
  return [middle - half, middle + half];
});

const cloudOf = (step) => {
  const { clouds } = theDrive();
  const { offsets, x, y, heading } = clouds;
  const i = lastAtMost(clouds.step, step);
  const poses = [];
  for (let p = offsets[i]; p < offsets[i + 1]; p++) poses.push([x[p], y[p], heading[p]]);
  return poses;
};

// Landmarks of the map at the end in a square: {x, y}.
const landmarksWithin = ([x0, x1], [y0, y1]) => {
  const { offsets, until, mature, x, y } = theDrive().landmarks;
  const found = { x: [], y: [] };
  for (let i = 0; i < until.length; i++) {
    const p = offsets[i + 1] - 1;
    if (until[i] >= 0 || mature[p] === 0 || x[p] < x0 || x[p] > x1 || y[p] < y0 || y[p] > y1) continue;
    found.x.push(x[p]);
    found.y.push(y[p]);
  }
  return found;
};

const trueLandmarksWithin = ([x0, x1], [y0, y1]) => {
  const known = theDrive().trueLandmarks || { x: [], y: [] };
  const inside = Array.from(known.x.keys()).filter((i) => known.x[i] >= x0 && known.x[i] <= x1 && known.y[i] >= y0 && known.y[i] <= y1);
  return { x: inside.map((i) => known.x[i]), y: inside.map((i) => known.y[i]) };
};

const drawView = (id, closure, view) => {
  const particles = cloudOf(view.step);
  const shown = [...particles, view.estimate, ...(view.truth ? [view.truth] : [])];
  const constellations = [];
  if (view.closing && closure.winner) {
    constellations.push(...constellation("matched", closure.winner, closure.matched, c.other, "circle-open"));
    shown.push(...closure.matched);
  }
  if (view.closing && closure.rival) {
    const there = closure.matched.map((p) => onto(closure.rival, seenFrom(closure.winner, p)));
    constellations.push(...constellation("matched, at the rival", closure.rival, there, c.bad, "x-thin"));
    shown.push(closure.rival, ...there);
  }
  const range = squareAround(shown);
  const length_m = .045 * (range[0][1] - range[0][0]);
  const cloud = strokes(particles, .6 * length_m);
  const mature = landmarksWithin(...range), known = trueLandmarksWithin(...range);
  draw(id, [
    dots("true landmarks", known.x, known.y, c.truth,
      { marker: { color: c.truth, size: 9, symbol: "circle-open" }, hoverinfo: "x+y" }),
    dots("landmarks", mature.x, mature.y, c.landmark),
    ...constellations,
    ...(view.truth ? arrow("true pose", view.truth, 1.4 * length_m, c.truth) : []),
    line("particles", cloud.x, cloud.y, c.ink, { line: { color: c.ink, width: 1 }, opacity: .6, hoverinfo: "skip" }),
    ...arrow("estimate", view.estimate, length_m, c.estimate),
    ...(view.closing && closure.rival ? arrow("best rival", closure.rival, length_m, c.bad) : []),
  ].filter((trace) => trace.x.length > 0), {
    xaxis: axis("x [m]", { range: range[0] }), yaxis: axis("y [m]", { range: range[1], scaleanchor: "x" }),
    margin: { l: 56, r: 40, t: 8, b: 44 }, showlegend: false,
  });
};

const viewTitle = (view) => {
  if (view.closing) return "At the closing";
  if (view.scans === 0) return "Where the attempt starts, as drawn on helices";
  return `After ${count(view.scans)} scan${view.scans === 1 ? "" : "s"}`;
};

const drawViews = (views, closure, k) => {
  closure.views.forEach((view, i) => {
    const panel = element("div");
    const chart = element("div", undefined, "chart");
    chart.id = `closure-${k}-${i}`;
    panel.append(element("h3", viewTitle(view)), chart);
    views.append(panel);
  });
  closure.views.forEach((view, i) => drawView(`closure-${k}-${i}`, closure, view));
};

// Many charts cost seconds: those of later closures are drawn when somebody opens them.
const drawClosures = () => {
  const opened_at_first = 2;
  const pictured = data.closures.filter((closure) => closure.views.length > 0);
  byId("closure-pictures").replaceChildren();
  if (pictured.length === 0) return;
  byId("closures-note").replaceChildren(
    "The attempt that led to each closure, in the map frame of the scan; particles are strokes in the direction of " +
    "travel. Before the closing the estimate is that of the mapping that goes on with the old landmarks set aside. ",
    ...[["particles", c.ink], ["estimate", c.estimate], ["true pose and landmarks", c.truth],
      ["landmarks of the map at the end", c.landmark], ["matched landmarks", c.other],
      ["the same seen from the best rival", c.bad]].map(([name, colour]) => {
      const entry = element("span", `■ ${name} `);
      entry.style.color = colour;
      return entry;
    }));
  pictured.forEach((closure, k) => {
    const box = element("details");
    const views = element("div", undefined, "views");
    box.append(element("summary", `Closure at step ${closure.step}: ${closure.verdict}`), views);
    byId("closure-pictures").append(box);
    const open = () => { if (box.open && views.childElementCount === 0) drawViews(views, closure, k); };
    box.addEventListener("toggle", open);
    box.open = k < opened_at_first;
  });
};
