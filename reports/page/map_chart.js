// The chart of map and path.
const ordinal = (n) => `${count(n)}${n % 100 - n % 10 === 10 ? "th" : { 1: "st", 2: "nd", 3: "rd" }[n % 10] || "th"}`;
const everyLandmarkText = () => (data.landmarks_stride > 1 ? `, every ${ordinal(data.landmarks_stride)}` : "");

// Sizes of marks on the map: many, or on a narrow screen, they would merge into bars.
const landmarkSize = (number) => (number > 1000 ? 3 : narrow.matches ? (number > 150 ? 3 : 4) : 6);
const trueLandmarkSize = (number) => (number > 1000 ? 5 : narrow.matches ? (number > 150 ? 5 : 7) : 10);

const landmarkTraces = (state, colour, symbol) => {
  const chosen = data.landmarks.filter((landmark) => landmark.state === state);
  if (chosen.length === 0) return [];
  const most_ellipses = 1500;  // more cost seconds, and none could be told from another
  const outlined = chosen.length > most_ellipses ? [] : chosen;
  const outline = ellipses(outlined.map((m) => [m.x, m.y, m.sxx, m.sxy, m.syy]));
  const name = `${state} landmarks${everyLandmarkText()}`;
  const text = chosen.map((m) => `landmark ${hoverName(m.id)}<br>${m.observations} observations<br>σ ${
    Math.sqrt(m.sxx).toFixed(3)} m, ${Math.sqrt(m.syy).toFixed(3)} m`);
  return [
    line(name, outline.x, outline.y, colour,
      { line: { color: colour, width: 1 }, hoverinfo: "skip", legendgroup: name, showlegend: false }),
    dots(name, chosen.map((m) => m.x), chosen.map((m) => m.y), colour,
      { marker: { color: colour, size: landmarkSize(chosen.length), symbol }, text, legendgroup: name,
        hovertemplate: "%{text}<br>(%{x:.2f}, %{y:.2f}) m<extra></extra>" }),
  ];
};

const truthTraces = () => {
  const truth = data.truth;
  if (!truth) return [];
  if (!truth.aligned) return [line("true path", truth.x, truth.y, c.truth, { line: { color: c.truth, width: 1.6 } })];
  return [
    dots(data.antenna ? `fixes (of the antenna, ${antennaPlace()})` : "fixes", truth.x, truth.y, c.truth, { marker: { color: c.truth, size: 3.5 }, hoverinfo: "x+y" }),
    dots("fixes left out", truth.left_out_x, truth.left_out_y, c.bad,
      { marker: { color: c.bad, size: 7, symbol: "x-thin", line: { color: c.bad, width: 1.5 } } }),
  ].filter((trace) => trace.x.length > 0);
};

const closureTrace = () => {
  const closures = data.decisions.filter((decision) => decision.kind === "closure");
  const looks = {
    accepted: ["star", c.landmark, 14], refused: ["x", c.bad, 11], undecided: ["circle-open", c.faint, 12],
    "new-ground": ["diamond-open", c.faint, 12] };
  return Object.entries(looks).flatMap(([verdict, [symbol, colour, size]]) => {
    const chosen = closures.filter((d) => d.verdict === verdict);
    if (chosen.length === 0) return [];
    return [dots(verdict === "new-ground" ? "new ground" : `closings ${verdict}`, chosen.map((d) => d.x), chosen.map((d) => d.y), colour,
      { marker: { color: colour, size, symbol, line: { color: symbol.endsWith("-open") ? colour : c.paper, width: 1.5 } },
        hovertemplate: "%{text}<extra></extra>", text: chosen.map((d) => `${d.verdict} at step ${d.step}`) })];
  });
};

const finalTrace = () => (data.final_path && filtered
  ? [line("corrected path", data.final_path.x, data.final_path.y, c.landmark,
    { line: { color: c.landmark, width: 1.3, dash: "dash" } })] : []);

const drawMap = () => {
  const path = data.path;
  const outline = ellipses(path.ellipses);
  const known_x = data.true_landmarks.map((m) => m[1]);
  const known_y = data.true_landmarks.map((m) => m[2]);
  const ends = path.x.length === 0 ? [] : [dots("start, end", [path.x[0], last(path.x)], [path.y[0], last(path.y)], c.ink,
    { marker: { color: [c.paper, c.ink], size: 10, symbol: ["circle", "square"], line: { color: c.ink, width: 2 } },
      text: ["start", "end"], hovertemplate: "%{text}<extra></extra>" })];
  draw("map", [
    ...truthTraces(),
    ...pathsTraces(),
    line(filtered ? "estimated path" : "smoothed path", path.x, path.y, c.estimate, { line: { color: c.estimate, width: 2 }, customdata: path.t,
      hovertemplate: "%{customdata:.1f} s<br>(%{x:.2f}, %{y:.2f}) m<extra>estimate</extra>" }),
    ...finalTrace(),
    ...(filtered ? [line("95 % ellipses", outline.x, outline.y, c.estimate,
      { line: { color: c.estimate, width: 1 }, opacity: .55, hoverinfo: "skip" })] : []),
    ...(known_x.length > 0 ? [dots("true landmarks", known_x, known_y, c.truth,
      { marker: { color: c.truth, size: trueLandmarkSize(known_x.length), symbol: "circle-open" }, hoverinfo: "x+y" })] : []),
    ...landmarkTraces("tentative", c.faint, "diamond"),
    ...landmarkTraces("mature", c.landmark, "circle"),
    ...mixtureTraces(),
    ...closureTrace(),
    ...ends,
  ], {
    xaxis: axis("x [m]", { range: data.map_extent.slice(0, 2) }),
    yaxis: axis("y [m]", { range: data.map_extent.slice(2), scaleanchor: "x" }),
  });
  const frame = { fixes: "that of the position fixes", earlier: "that of the earlier map", start: "pose at the start" }[data.frame];
  byId("map-note").textContent = (filtered
    ? `Map frame (${frame}). Ellipses hold the true position with 95 % if the filter is right; those of the
       path stand ${path.ellipse_stride === 1 ? "a scan" : `${count(path.ellipse_stride)} scans`} apart.`
    : `Optimum of all measurements in the map frame (${frame}). Ellipses hold the true position of a landmark
       with 95 % if the covariances are right.`) + particlesMapNote() +
    (data.truth && data.truth.aligned ? " The fixes were brought into the map frame by the alignment." : "");
};
