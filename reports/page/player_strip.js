// The drive as a strip of time: searches, and ticks where closings were accepted or refused.
const drawStrip = ({ drive, end, closings, stretches }) => {
  const strip = byId("player-strip");
  const ratio = window.devicePixelRatio || 1;
  strip.width = Math.round(strip.clientWidth * ratio);
  strip.height = Math.round(strip.clientHeight * ratio);
  const context = strip.getContext("2d");
  const x = (k) => (end > 0 ? drive.t[k] / end : 0) * strip.width;
  context.fillStyle = c.band;
  context.fillRect(0, 0, strip.width, strip.height);
  context.fillStyle = c.other;
  stretches.from.forEach((from, s) => {
    if (stretches.searching[s] === 0) return;
    context.fillRect(x(from), .55 * strip.height, Math.max(1, x(stretches.to[s]) - x(from)), strip.height);
  });
  const colour = { accepted: c.landmark, refused: c.bad };
  for (const closing of closings) {
    context.fillStyle = colour[closing.verdict] || c.faint;
    context.fillRect(x(closing.step - drive.firstStep) - ratio, 0, 2 * ratio, .55 * strip.height);
  }
};
