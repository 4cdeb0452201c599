// Cards, tables, and how the run was made.
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

const finalTable = (error) => table("Position of the corrected path (trajectory_final.tum)", statisticsRows(error, "m", metres));

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
    card(`${closures.accepted} / ${closures.refused} / ${closures.new_ground || 0} / ${closures.undecided}`,
         "closures accepted / refused / new ground / undecided");
  }
  const passes = summary.steps > 1;  // a single scan has neither way nor time
  card(count(summary.steps), filtered && passes ? `scans in ${duration(data.duration_s)}` : summary.steps === 1 ? "scan" : "scans");
  if (passes) card(`${count(Math.round(data.length_m))} m`, "path");
  if (filtered) {
    card(microseconds(clock.timing.median_us), `per scan, median (99 % within ${microseconds(clock.timing.p99_us)})`);
  } else {
    card(`${fixed(clock.timing.solving_s, 3)} s`, `to solve, after ${fixed(clock.timing.reading_s, 3)} s of reading`);
  }
  const tables = byId("tables");
  if (error) tables.append(positionTable(error));
  if (summary.error_final) tables.append(finalTable(summary.error_final));
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
