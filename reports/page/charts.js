// The charts of a run.
const dark = window.matchMedia("(prefers-color-scheme: dark)");
const narrow = window.matchMedia("(max-width: 600px)");
const colours = () => (dark.matches
  ? { paper: "#14181f", ink: "#e6eaf0", grid: "#2b333e", zero: "#4a5564", estimate: "#5aa9ee", truth: "#f0a04b",
      landmark: "#5fc98f", faint: "#7d8896", bad: "#f2867e", band: "rgba(90,169,238,.18)", other: "#b79af0" }
  : { paper: "#ffffff", ink: "#1b2330", grid: "#e7eaee", zero: "#b4bcc6", estimate: "#0b62a8", truth: "#d9730d",
      landmark: "#1a7f4b", faint: "#8a94a1", bad: "#b3261e", band: "rgba(11,98,168,.14)", other: "#6b46c1" });
let c = colours();

const axis = (title, more) => ({
  title: { text: title, standoff: 8 }, gridcolor: c.grid, zerolinecolor: c.zero, linecolor: c.zero, automargin: true,
  ...more,
});
const timeAxis = (more) => axis("time in the log [s]", { zeroline: false, range: data.time_range_s, ...more });
const layout = (more) => ({
  paper_bgcolor: c.paper, plot_bgcolor: c.paper, font: { color: c.ink, size: 13 }, dragmode: "pan",
  margin: { l: 70, r: 44, t: 46, b: 56 }, modebar: { orientation: "v" }, hovermode: "closest", autosize: true,
  legend: { orientation: "h", x: 0, xanchor: "left", y: 1.02, yanchor: "bottom", bgcolor: "rgba(0,0,0,0)" }, ...more,
});
// The charting library is a megabyte of script: it is run when the first chart is drawn.
const needCharts = () => {
  if (window.Plotly) return;
  const script = element("script");
  script.textContent = byId("charts").textContent;
  document.head.append(script);
};

// Plotly places the legend of a resized chart by the margins from before: drawn a second time it stands above the chart again.
const fitChart = async (chart) => {
  await Plotly.Plots.resize(chart);
  await Plotly.redraw(chart);
};

const sizes = new WeakMap();  // [chart] as drawn or fitted last
const sizeOf = (chart) => `${chart.clientWidth} ${chart.clientHeight}`;
const resizing = new ResizeObserver((entries) => {
  for (const { target } of entries) {
    if (target.clientWidth === 0 || sizes.get(target) === sizeOf(target)) continue;
    sizes.set(target, sizeOf(target));
    fitChart(target);
  }
});

const draw = (id, traces, more) => {
  needCharts();
  if (!sizes.has(byId(id))) sizes.set(byId(id), sizeOf(byId(id)));
  resizing.observe(byId(id));
  return plot(id, traces, more);
};

const plot = (id, traces, more) => Plotly.react(byId(id), traces, layout(more), {
  scrollZoom: true, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d"],
  toImageButtonOptions: { filename: `helixnav-${id}`, scale: 2 },
});
const line = (name, x, y, colour, more) =>
  ({ type: "scatter", mode: "lines", name, x, y, line: { color: colour, width: 1.6 }, ...more });
const dots = (name, x, y, colour, more) =>
  ({ type: "scatter", mode: "markers", name, x, y, marker: { color: colour, size: 5 }, ...more });
// Two lines with the space between them filled; one entry in the legend.
const bandPiece = (name, x, low, high, more) => [
  { type: "scatter", mode: "lines", x, y: low, line: { width: 0 }, hoverinfo: "skip", legendgroup: name, ...more,
    showlegend: false },
  { type: "scatter", mode: "lines", name, x, y: high, line: { width: 0 }, fill: "tonexty", fillcolor: c.band,
    hoverinfo: "skip", legendgroup: name, ...more },
];

// In pieces where the lines have gaps (null): Plotly would fill across them.
const band = (name, x, low, high, more) => {
  const pieces = [];
  for (let from = 0; from <= low.length;) {
    const gap = low.indexOf(null, from);
    const to = gap < 0 ? low.length : gap;
    const later = pieces.length > 0 ? { showlegend: false } : {};
    if (to > from || low.length === 0) {
      pieces.push(...bandPiece(name, x.slice(from, to), low.slice(from, to), high.slice(from, to), { ...more, ...later }));
    }
    from = to + 1;
  }
  return pieces;
};

// Outline of {e : eᵀP⁻¹e = 5.99}, the 95 % region of a Gaussian in the plane, all in one line with gaps.
const ellipses = (items) => {
  const x = [];
  const y = [];
  const corners = 28;
  for (const [mx, my, sxx, sxy, syy] of items) {
    const l11 = Math.sqrt(Math.max(sxx, 0));
    const l21 = l11 > 0 ? sxy / l11 : 0;
    const l22 = Math.sqrt(Math.max(syy - l21 * l21, 0));
    for (let k = 0; k <= corners; k++) {
      const u = 2.4477 * Math.cos(2 * Math.PI * k / corners);
      const v = 2.4477 * Math.sin(2 * Math.PI * k / corners);
      x.push(+(mx + l11 * u).toFixed(4));
      y.push(+(my + l21 * u + l22 * v).toFixed(4));
    }
    x.push(null);
    y.push(null);
  }
  return { x, y };
};

const errorRows = () => {
  const e = data.errors;
  const rows = e
    ? [["x", "m", e.t, e.x, e.sx], ["y", "m", e.t, e.y, e.sy]]
    : [["x", "m", data.health.t, null, data.health.sx], ["y", "m", data.health.t, null, data.health.sy]];
  if (data.heading) rows.push(["heading", "°", data.heading.t, data.heading.e, data.heading.s]);
  else if (!e) rows.push(["heading", "°", data.health.t, null, data.health.sh]);
  return rows;
};

const drawErrors = () => {
  byId("errors-section").hidden = empty || (!filtered && !data.errors);
  if (byId("errors-section").hidden) return;
  const rows = errorRows();
  const traces = [];
  const lowest = `y${rows.length}`;
  const more = { height: 200 * rows.length + 100, xaxis: timeAxis({ anchor: lowest }) };
  const what = data.errors ? "error in " : "±3σ of ";
  const gap = 0.05;
  const height = (1 - gap * (rows.length - 1)) / rows.length;
  rows.forEach(([name, unit, t, error, sigma], k) => {
    const id = k === 0 ? "" : k + 1;
    const top = 1 - k * (height + gap);
    const here = { yaxis: `y${id}`, xaxis: "x" };
    const three = sigma.map((s) => 3 * s);
    if (filtered) traces.push(...band("±3σ of the filter", t, three.map((s) => -s), three,
      { ...here, ...(k > 0 ? { showlegend: false } : {}) }));
    if (error) {
      traces.push((data.errors.aligned ? dots : line)("estimate − truth", t, error, c.estimate,
        { ...here, showlegend: k === 0, legendgroup: "error", marker: { color: c.estimate, size: 3.5 },
          line: { color: c.estimate, width: 1.3 }, hovertemplate: `%{x:.1f} s: %{y:.3f} ${unit}<extra></extra>` }));
    }
    more[`yaxis${id}`] = axis(`${what}${name} [${unit}]`, { domain: [Math.max(0, top - height), top], anchor: "x" });
  });
  byId("errors").style.height = `${more.height}px`;
  draw("errors", traces, more);
  byId("errors-title").textContent = data.errors ? "Errors over time" : "Uncertainty over time";
  byId("errors-note").textContent = !data.errors
    ? "No truth is known: the band is what the filter believes of itself."
    : data.errors.aligned
      ? "Estimated antenna position minus fix along the axes of the map frame, after the alignment." +
        (filtered ? " The band is that of the estimate; the noise of the fixes comes on top." : "")
      : "Estimate minus truth along the axes of the map frame, without any alignment.";
};

const drawNis = () => {
  const n = data.nis;
  const top = Math.max(3, 1.15 * Math.max(0, ...n.high, ...n.mean));
  draw("nis", [
    ...band("two-sided 95 % band", n.t, n.low, n.high),
    dots("single updates", n.steps_t, n.steps, c.faint, { marker: { color: c.faint, size: 3 }, opacity: .55,
      hovertemplate: "%{x:.1f} s: %{y:.2f}<extra></extra>" }),
    line("mean of a block", n.t, n.mean, c.estimate, { hovertemplate: "%{x:.1f} s: %{y:.2f}<extra></extra>" }),
  ], { xaxis: timeAxis(), yaxis: axis("NIS / dof [–]", { range: [0, top] }) });
  byId("nis-note").textContent = n.t.length === 0 ? "No update was made in this run."
    : `Normalised innovation squared of the joint updates, and its mean over blocks of ${count(n.block)} updates with
       the band that such a mean keeps to with 95 % if the filter is consistent. Gaps: scans without an update.`;
};

const drawLandmarks = () => {
  const h = data.health;
  draw("landmarks", [
    line("in the map", h.t, h.mapped, c.landmark, { line: { color: c.landmark, width: 2, shape: "hv" } }),
    line("active", h.t, h.active, c.estimate, { line: { color: c.estimate, width: 1.4, shape: "hv" } }),
  ], { xaxis: timeAxis(), yaxis: axis("landmarks [count]", { rangemode: "tozero" }) });
};

const drawObservations = () => {
  const o = data.observations;
  const shade = { matched: c.landmark, augmented: c.estimate, ambiguous: c.truth, rejected: c.bad };
  draw("observations", Object.keys(shade).map((name) => ({
    type: "scatter", mode: "lines", name, x: o.t, y: o[name], stackgroup: "all",
    line: { width: .5, color: shade[name], shape: "hv" }, hovertemplate: "%{y:.2f} a scan",
  })), {
    xaxis: timeAxis(), yaxis: axis("observations per scan [count]", { rangemode: "tozero" }), hovermode: "x unified",
  });
  byId("observations-note").textContent = `What became of the observations, mean over ${count(o.block)} scans.`;
};

const drawTiming = () => {
  const w = clock.steps;
  draw("timing", [
    dots(w.block > 1 ? "slowest of a block" : "step", w.t, w.max_us, c.faint, { marker: { color: c.faint, size: 3.5 },
      hovertemplate: "%{x:.1f} s: %{y:.0f} µs<extra></extra>" }),
    ...(w.block > 1 ? [line("median of a block", w.t, w.median_us, c.estimate)] : []),
  ], {
    xaxis: timeAxis(), yaxis: axis("time per step [µs]", { type: "log", dtick: 1 }),
  });
  byId("timing-note").textContent = `Wall clock of the estimator: median ${microseconds(clock.timing.median_us)},
    99 % ${microseconds(clock.timing.p99_us)}, maximum ${microseconds(clock.timing.max_us)}.` +
    (w.block > 1 ? ` Blocks of ${w.block} scans.` : "");
};

const drawSmoothing = () => {
  const s = smoothing;
  if (!s) return;
  byId("smoothing").hidden = false;
  byId("smoothing-note").textContent = `Path and map before and after ${count(s.chi2.length - 1)} iterations: χ² ${
    fixed(s.chi2[0], 1)} to ${fixed(last(s.chi2), 1)}.`;
  const named = (map) => ({ text: map.id, hovertemplate: "landmark %{text}<br>(%{x:.2f}, %{y:.2f}) m<extra></extra>" });
  draw("smoothing-map", [
    line("path before", s.path_before.x, s.path_before.y, c.truth, { line: { color: c.truth, width: 1.2 } }),
    dots("landmarks before", s.before.x, s.before.y, c.truth,
      { ...named(s.before), marker: { color: c.truth, size: 5, symbol: "circle-open" } }),
    line("path after", s.path.x, s.path.y, c.estimate),
    dots("landmarks after", s.after.x, s.after.y, c.landmark, named(s.after)),
  ], { xaxis: axis("x [m]"), yaxis: axis("y [m]", { scaleanchor: "x" }) });
  draw("smoothing-chi2", [{ ...line("χ²", s.chi2.map((_, k) => k), s.chi2, c.estimate), mode: "lines+markers" }],
    { xaxis: axis("iteration [count]", { rangemode: "tozero" }), yaxis: axis("χ² [–]", { type: "log" }) });
  const r = s.residuals;
  const ends = r.step.length > 0 ? [r.step[0], last(r.step)] : [];
  draw("smoothing-residuals", [
    ...band("±2σ", ends, ends.map(() => -2), ends.map(() => 2)),
    dots("residual", r.step, r.value, c.estimate, { marker: { color: c.estimate, size: 3 } }),
  ], { xaxis: axis("step [index]"), yaxis: axis("residual / σ [–]") });
  byId("smoothing-residuals-note").textContent =
    `${percent(r.inside_2sigma)} lie within 2σ; 95.4 % would if the covariances were right.`;
  byId("smoothing-largest").replaceChildren(element("h3", "Largest residuals"), residualTable(s.largest));
};
