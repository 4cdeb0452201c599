// Draws the report from the two JSON elements of the page. Frames: map frame, metres; times: seconds of the log.
"use strict";
(() => {
  const parse = (id) => JSON.parse(document.getElementById(id).textContent);
  const data = parse("run-data");
  const clock = parse("wall-clock");
  const summary = data.summary;
  const byId = (id) => document.getElementById(id);

  // --- text ---------------------------------------------------------------------------------------------------------
  const element = (name, text, className) => {
    const node = document.createElement(name);
    if (text !== undefined) node.textContent = text;
    if (className) node.className = className;
    return node;
  };
  const known = (value) => value !== null && value !== undefined;
  const fixed = (value, digits) => (known(value) ? value.toFixed(digits) : "–");
  const metres = (value) => (known(value) ? `${value.toFixed(Math.abs(value) < 10 ? 3 : 2)} m` : "–");
  const degrees = (radians) => (known(radians) ? `${(radians * 180 / Math.PI).toFixed(3)}°` : "–");
  const percent = (value) => (known(value) ? `${(100 * value).toFixed(1)} %` : "–");
  const count = (value) => (known(value) ? value.toLocaleString("en").replace(/,/g, "\u202f") : "–");
  const microseconds = (value) => {
    if (!known(value)) return "–";
    return value < 1000 ? `${value.toFixed(0)} µs` : `${(value / 1000).toFixed(1)} ms`;
  };
  const duration = (seconds) => {
    const minutes = Math.floor(seconds / 60);
    return minutes > 0 ? `${minutes} min ${Math.round(seconds - 60 * minutes)} s` : `${seconds.toFixed(1)} s`;
  };

  const table = (title, rows) => {
    const box = element("div");
    if (title) box.append(element("h3", title));
    const body = element("table");
    for (const [name, value] of rows) {
      const row = element("tr");
      row.append(element("td", name), element("td", value, "number"));
      body.append(row);
    }
    box.append(body);
    return box;
  };

  const statisticsRows = (statistics, unit, show) => [
    ["RMSE", show(statistics[`rmse_${unit}`])],
    ["median", show(statistics[`median_${unit}`])],
    ["95 %", show(statistics[`p95_${unit}`])],
    ["maximum", show(statistics[`max_${unit}`])],
  ];

  const positionTable = (error) => {
    const rows = statisticsRows(error, "m", metres);
    const aligned = error.against === "positions";
    rows.push([aligned ? "fixes used" : "instants compared", count(error.fixes_used)]);
    if (aligned) {
      rows.push([`fixes left out (beyond ${error.limit_m} m)`, count(error.fixes_left_out)]);
      rows.push(["rotation of the alignment", degrees(error.alignment.heading_rad)]);
    }
    return table(aligned ? "Position against fixes, after rigid alignment" : "Position against the true pose", rows);
  };

  const poseTable = () => table("Heading and consistency of the pose", [
    ...statisticsRows(summary.heading_error, "rad", degrees).slice(0, 3),
    ["NEES, mean (3 when consistent)", fixed(summary.nees.mean, 2)],
    ["NEES inside its 95 % band", percent(summary.nees.inside_95)],
  ]);

  const landmarkTable = (error) => table(`Landmarks against the true ones, by ${error.by}`, [
    ...statisticsRows(error, "m", metres),
    ["pairs", count(error.pairs)],
    ["missing / duplicates / spurious", `${error.missing} / ${error.duplicates} / ${error.spurious}`],
  ]);

  // A smoother's run without a filter: no steps that were estimated one after the other, so nothing of them to show.
  const smoothing = data.smoothing;
  const filtered = !(smoothing && smoothing.alone);
  // A cloud of particles, each with a path and a map: no closures.
  const particles = data.particles;
  const last = (list) => list[list.length - 1];

  const smoothingTable = () => table("Least squares", [
    ["χ² at the start", fixed(smoothing.chi2[0], 2)],
    ["χ² of the optimum", fixed(last(smoothing.chi2), 2)],
    ["of it odometry", fixed(smoothing.chi2_odometry, 2)],
    ["of it landmarks", fixed(smoothing.chi2_landmarks, 2)],
    ["degrees of freedom", count(smoothing.dof)],
    ["χ² over degrees of freedom (1 when the covariances are right)", fixed(last(smoothing.chi2) / smoothing.dof, 3)],
    ["iterations", count(smoothing.chi2.length - 1)],
  ]);

  const filterTable = () => table("Filter", [
    ["updates", count(summary.nis.updates)],
    ["NIS per degree of freedom (1 when consistent)", fixed(summary.nis.mean_per_dof, 3)],
    ["95 % band of that mean", `${fixed(summary.nis.mean_low_95, 3)} … ${fixed(summary.nis.mean_high_95, 3)}`],
    ["single updates inside their 95 % band", percent(summary.nis.inside_95)],
    ...Object.entries(summary.observations).map(([name, value]) => [`observations ${name}`, count(value)]),
  ]);

  const particlesTable = () => table("Particles", [
    ["effective size by the hypotheses weighed, mean", percent(summary.particles.effective_share)],
    ["resamplings", count(summary.particles.resamplings)],
    ["ancestors a loop ago, mean", fixed(summary.particles.ancestors_mean, 1)],
    ["ancestors a loop ago, least", count(summary.particles.ancestors_least)],
  ]);

  const clockTable = () => table("Wall clock", Object.entries(clock.timing).filter(
    ([name]) => filtered || !(name.endsWith("_us") || name === "steps_s")).map(([name, value]) => {
    const quantile = { median_us: "median", p99_us: "99 %", max_us: "maximum" }[name];
    if (quantile) return [`${quantile} per scan`, microseconds(value)];
    if (name === "steps_s") return ["all scans", `${fixed(value, 2)} s`];
    if (name.endsWith("_s")) return [name.slice(0, -2).replace(/_/g, " "), `${fixed(value, 2)} s`];
    return [name, String(value)];
  }));

  const card = (value, name) => {
    const box = element("div", undefined, "card");
    box.append(element("b", value), element("span", name));
    byId("cards").append(box);
  };

  const writeSummary = () => {
    const error = summary.error;
    if (error) card(metres(error.rmse_m), "position error, RMSE");
    if (error) card(metres(error.median_m), "position error, median");
    if (summary.landmark_error) card(metres(summary.landmark_error.rmse_m), "landmark error, RMSE");
    if (smoothing) card(fixed(last(smoothing.chi2), 2), `χ² of the optimum, ${count(smoothing.dof)} degrees of freedom`);
    if (smoothing) card(fixed(last(smoothing.chi2) / smoothing.dof, 3), "χ² over degrees of freedom");
    card(count(summary.landmarks.mature),
         filtered ? `mature landmarks, ${count(summary.landmarks.tentative)} tentative` : "landmarks");
    if (particles) {
      card(`${fixed(summary.particles.ancestors_mean, 1)} / ${count(summary.particles.ancestors_least)}`,
           "ancestors of all particles a loop ago, mean / least");
    } else if (filtered) {
      const closures = summary.closures;
      card(`${closures.accepted} / ${closures.refused} / ${closures.undecided}`,
           "closures accepted / refused / undecided");
    }
    card(count(summary.steps), filtered ? `scans in ${duration(data.duration_s)}` : "scans");
    card(`${count(Math.round(data.length_m))} m`, "path");
    if (filtered) {
      card(microseconds(clock.timing.median_us), `per scan, median (99 % within ${microseconds(clock.timing.p99_us)})`);
    } else {
      card(`${fixed(clock.timing.solving_s, 3)} s`, `to solve, after ${fixed(clock.timing.reading_s, 3)} s of reading`);
    }
    const tables = byId("tables");
    if (error) tables.append(positionTable(error));
    if (summary.heading_error) tables.append(poseTable());
    if (summary.landmark_error) tables.append(landmarkTable(summary.landmark_error));
    if (smoothing) tables.append(smoothingTable());
    if (particles) tables.append(particlesTable());
    if (filtered) tables.append(filterTable());
    tables.append(clockTable());
  };

  const writeHeader = () => {
    const manifest = data.manifest;
    const title = manifest.recording || "unnamed recording";
    document.title = `${title} – HelixNav`;
    byId("title").textContent = title;
    byId("command").textContent = manifest.command;
    const origin = [`HelixNav ${manifest.version}`];
    if (manifest.commit) origin.push(`commit ${manifest.commit.slice(0, 12)}`);
    origin.push(`seed ${data.seed}`);
    if (!data.finished) origin.push("cut off before its end");
    byId("origin").textContent = origin.join(" · ");
    byId("config").textContent =
      typeof manifest.config === "string" ? manifest.config : JSON.stringify(manifest.config, null, 2);
    byId("configuration").hidden = !manifest.config;
    const rows = manifest.inputs.map((input) => [input.name, `SHA-256 ${input.sha256.slice(0, 16)}…`]);
    byId("inputs").append(rows.length > 0 ? table("Input", rows) : element("p", "No input files.", "quiet"));
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
      row.append(element("td", count(decision.step)), element("td", fixed(decision.t, 2)), element("td", decision.kind),
                 element("td", decision.verdict, state), element("td", numbers.join(", "), "numbers"));
      box.append(row);
    }
    return box;
  };

  const residualTable = (residuals) => {
    const box = element("table");
    const head = element("tr");
    for (const name of ["step", "measurement", "eᵀC⁻¹e", "rows"]) head.append(element("th", name));
    box.append(head);
    for (const residual of residuals) {
      const row = element("tr");
      row.append(element("td", count(residual.step)), element("td", residual.name), element("td", fixed(residual.nis, 1)),
                 element("td", count(residual.rows)));
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

  // --- charts -------------------------------------------------------------------------------------------------------
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
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
  const draw = (id, traces, more) => Plotly.react(byId(id), traces, layout(more), {
    responsive: true, scrollZoom: true, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d"],
    toImageButtonOptions: { filename: `helixnav-${id}`, scale: 2 },
  });
  const line = (name, x, y, colour, more) =>
    ({ type: "scatter", mode: "lines", name, x, y, line: { color: colour, width: 1.6 }, ...more });
  const dots = (name, x, y, colour, more) =>
    ({ type: "scatter", mode: "markers", name, x, y, marker: { color: colour, size: 5 }, ...more });
  // Two lines with the space between them filled; one entry in the legend.
  const band = (name, x, low, high, more) => [
    { type: "scatter", mode: "lines", x, y: low, line: { width: 0 }, hoverinfo: "skip", showlegend: false,
      legendgroup: name, ...more },
    { type: "scatter", mode: "lines", name, x, y: high, line: { width: 0 }, fill: "tonexty", fillcolor: c.band,
      hoverinfo: "skip", legendgroup: name, ...more },
  ];

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

  const landmarkTraces = (state, colour, symbol) => {
    const chosen = data.landmarks.filter((landmark) => landmark.state === state);
    if (chosen.length === 0) return [];
    const outline = ellipses(chosen.map((m) => [m.x, m.y, m.sxx, m.sxy, m.syy]));
    const name = `${state} landmarks`;
    const text = chosen.map((m) => `landmark ${m.id}<br>${m.observations} observations<br>σ ${
      Math.sqrt(m.sxx).toFixed(3)} m, ${Math.sqrt(m.syy).toFixed(3)} m`);
    return [
      line(name, outline.x, outline.y, colour,
        { line: { color: colour, width: 1 }, hoverinfo: "skip", legendgroup: name, showlegend: false }),
      dots(name, chosen.map((m) => m.x), chosen.map((m) => m.y), colour,
        { marker: { color: colour, size: 6, symbol }, text, legendgroup: name,
          hovertemplate: "%{text}<br>(%{x:.2f}, %{y:.2f}) m<extra></extra>" }),
    ];
  };

  const truthTraces = () => {
    const truth = data.truth;
    if (!truth) return [];
    if (!truth.aligned) return [line("true path", truth.x, truth.y, c.truth, { line: { color: c.truth, width: 1.6 } })];
    return [
      dots("fixes", truth.x, truth.y, c.truth, { marker: { color: c.truth, size: 3.5 }, hoverinfo: "x+y" }),
      dots("fixes left out", truth.left_out_x, truth.left_out_y, c.bad,
        { marker: { color: c.bad, size: 7, symbol: "x-thin", line: { color: c.bad, width: 1.5 } } }),
    ].filter((trace) => trace.x.length > 0);
  };

  const closureTrace = () => {
    const closures = data.decisions.filter((decision) => decision.kind === "closure");
    if (closures.length === 0) return [];
    return [dots("closures", closures.map((d) => d.x), closures.map((d) => d.y), c.other,
      { marker: { color: c.other, size: 13, symbol: "star" }, hovertemplate: "%{text}<extra></extra>",
        text: closures.map((d) => `${d.verdict} at step ${d.step}`) })];
  };

  const pathsTraces = () => {
    if (!particles || !particles.paths) return [];
    return [line(`paths of ${count(particles.paths.ends)} particles`, particles.paths.x, particles.paths.y, c.other,
      { line: { color: c.other, width: 1 }, opacity: .7, hoverinfo: "skip" })];
  };

  const mixtureTraces = () => {
    if (!particles || !particles.mixture || particles.mixture.length === 0) return [];
    const name = "landmarks of the mixture";
    const outline = ellipses(particles.mixture.map((m) => [m.x, m.y, m.sxx, m.sxy, m.syy]));
    return [
      line(name, outline.x, outline.y, c.other,
        { line: { color: c.other, width: 1, dash: "dot" }, hoverinfo: "skip", legendgroup: name, showlegend: false }),
      dots(name, particles.mixture.map((m) => m.x), particles.mixture.map((m) => m.y), c.other,
        { marker: { color: c.other, size: 6, symbol: "x-thin", line: { color: c.other, width: 1.5 } }, legendgroup: name,
          text: particles.mixture.map((m) => `landmark ${m.id}<br>in ${percent(m.share)} of the weight`),
          hovertemplate: "%{text}<br>(%{x:.2f}, %{y:.2f}) m<extra></extra>" }),
    ];
  };

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
      ...(filtered ? [line("95 % ellipses", outline.x, outline.y, c.estimate,
        { line: { color: c.estimate, width: 1 }, opacity: .55, hoverinfo: "skip" })] : []),
      ...(known_x.length > 0 ? [dots("true landmarks", known_x, known_y, c.truth,
        { marker: { color: c.truth, size: 10, symbol: "circle-open" }, hoverinfo: "x+y" })] : []),
      ...landmarkTraces("tentative", c.faint, "diamond"),
      ...landmarkTraces("mature", c.landmark, "circle"),
      ...mixtureTraces(),
      ...closureTrace(),
      ...ends,
    ], {
      xaxis: axis("x [m]", { range: data.map_extent.slice(0, 2) }),
      yaxis: axis("y [m]", { range: data.map_extent.slice(2), scaleanchor: "x" }),
    });
    byId("map-note").textContent = (filtered
      ? `Map frame (pose at the start). Ellipses hold the true position with 95 % if the filter is right; those of the
         path stand ${count(path.ellipse_stride)} scans apart.`
      : `Optimum of all measurements in the map frame (pose at the start). Ellipses hold the true position of a landmark
         with 95 % if the covariances are right.`) +
      (particles ? " Landmarks are those of the heaviest particle; those of the mixture are in most of the weight as mature." +
        " Looking back, the paths of all particles join." : "") +
      (data.truth && data.truth.aligned ? " The fixes were brought into the map frame by the alignment." : "");
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
    byId("errors-section").hidden = !filtered && !data.errors;
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

  const drawParticles = () => {
    if (!particles) return;
    const h = particles.health;
    draw("particles", [
      line("hypotheses weighed", h.t, h.hypotheses, c.faint),
      line("effective size", h.t, h.effective, c.estimate),
      line("ancestors a loop ago", h.t, h.ancestors, c.bad, { line: { color: c.bad, width: 2, shape: "hv" } }),
    ], { xaxis: timeAxis(), yaxis: axis("particles [count]", { type: "log" }) });
    byId("particles-note").textContent =
      `Of how many particles a loop's length ago (fastslam.genealogy_m) those of today descend: 1 says that the path of before
       is a single guess, and the covariance knows nothing of the others. The effective size is no alarm for that.` +
      (h.block > 1 ? ` Blocks of ${h.block} scans: means, and the least number of ancestors.` : "");
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
         the band that such a mean keeps to with 95 % if the filter is consistent.`;
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

  // --- closures -----------------------------------------------------------------------------------------------------
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

  const drawView = (id, closure, view) => {
    const shown = [...view.cloud, view.estimate, ...(view.truth ? [view.truth] : [])];
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
    const cloud = strokes(view.cloud, .6 * length_m);
    const mature = data.landmarks.filter((m) => m.state === "mature");
    draw(id, [
      dots("true landmarks", data.true_landmarks.map((m) => m[1]), data.true_landmarks.map((m) => m[2]), c.truth,
        { marker: { color: c.truth, size: 9, symbol: "circle-open" }, hoverinfo: "x+y" }),
      dots("landmarks", mature.map((m) => m.x), mature.map((m) => m.y), c.landmark),
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
      open();
    });
  };

  const drawAll = () => {
    c = colours();
    for (const chart of [drawMap, drawErrors, drawSmoothing]) chart();
    if (!filtered) return;
    for (const chart of [drawParticles, drawNis, drawLandmarks, drawObservations, drawTiming, drawClosures]) chart();
  };

  const hide = (className, hidden) => {
    for (const section of document.querySelectorAll(className)) section.hidden = hidden;
  };
  hide(".of-filter", !filtered);
  hide(".of-navigator", !filtered || Boolean(particles));
  hide(".of-particles", !particles);
  writeHeader();
  writeSummary();
  writeDecisions();
  drawAll();
  dark.addEventListener("change", drawAll);
})();
