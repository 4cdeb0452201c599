// What only a cloud of particles has: paths that descend from each other, landmarks of the mixture, its health.
const particles = data.particles;

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
        text: particles.mixture.map((m) => `landmark ${hoverName(m.id)}<br>in ${percent(m.share)} of the weight`),
        hovertemplate: "%{text}<br>(%{x:.2f}, %{y:.2f}) m<extra></extra>" }),
  ];
};

const particlesMapNote = () => (particles
  ? " Landmarks are those of the heaviest particle; those of the mixture are in most of the weight as mature. " +
    "Looking back, the paths of all particles join."
  : "");

const particlesTable = () => table("Particles", [
  ["effective size by the hypotheses weighed, mean", percent(summary.particles.effective_share)],
  ["resamplings", count(summary.particles.resamplings)],
  ["ancestors a loop ago, mean", fixed(summary.particles.ancestors_mean, 1)],
  ["ancestors a loop ago, least", count(summary.particles.ancestors_least)],
]);

const drawParticles = () => {
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
