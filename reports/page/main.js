// Puts the page together. Charts cost a second each on a slow machine: each is drawn when it comes into view.
const charts = new Map([
  ["map", drawMap], ["errors-section", drawErrors], ["smoothing", drawSmoothing],
  ...(filtered ? [["nis", drawNis], ["landmarks", drawLandmarks], ["observations", drawObservations],
    ["timing", drawTiming]] : []),
  ...(filtered && !particles ? [["closure-pictures", drawClosures]] : []),
  ...(particles ? [["particles", drawParticles]] : []),
]);
const drawn = new Set();

const drawChart = (id) => {
  drawn.add(id);
  charts.get(id)();
};
const drawAll = () => [...charts.keys()].forEach(drawChart);
const redraw = () => {
  c = colours();
  [...drawn].forEach(drawChart);
};

const drawWhenSeen = () => {
  const watch = new IntersectionObserver((entries) => {
    for (const entry of entries.filter((one) => one.isIntersecting && !drawn.has(one.target.id))) {
      watch.unobserve(entry.target);
      drawChart(entry.target.id);
    }
  }, { rootMargin: "300px" });
  for (const id of charts.keys()) watch.observe(byId(id));
};

const hide = (className, hidden) => {
  for (const section of document.querySelectorAll(className)) section.hidden = hidden;
};
hide(".of-scans", empty);
hide(".of-filter", !filtered || empty);
hide(".of-navigator", !filtered || Boolean(particles) || empty);
hide(".of-particles", !particles);
byId("errors-section").hidden = empty || (!filtered && !data.errors);
byId("smoothing").hidden = !smoothing;
dark.addEventListener("change", redraw);
narrow.addEventListener("change", redraw);  // marks have other sizes then
writeHeader();
writeAntenna();
writeOpening();
writeSummary();
writeDecisions();
requestAnimationFrame(() => setTimeout(startPlayer));  // after the sentences are on the screen
drawWhenSeen();
window.addEventListener("beforeprint", drawAll);
