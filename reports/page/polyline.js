// A long line in levels of detail: level n leaves out points nearer than 0.1·3ⁿ m to the last one kept. Drawn is the level that
// a screen can show, and of it the stretches that are in view.
const points_of_stretch = 64;

const boxesOf = (x, y, kept) => {
  const boxes = [];
  for (let begin = 0; begin < kept.length; begin += points_of_stretch) {
    const box = [Infinity, -Infinity, Infinity, -Infinity];
    for (let i = begin; i <= Math.min(begin + points_of_stretch, kept.length - 1); i++) {
      const px = x[kept[i]], py = y[kept[i]];
      box[0] = Math.min(box[0], px);
      box[1] = Math.max(box[1], px);
      box[2] = Math.min(box[2], py);
      box[3] = Math.max(box[3], py);
    }
    boxes.push(box);
  }
  return boxes;
};

const thinned = (x, y, finer, spacing) => {
  const kept = [];
  let before = -1;
  for (const i of finer) {
    if (before >= 0 && Math.hypot(x[i] - x[before], y[i] - y[before]) < spacing) continue;
    kept.push(i);
    before = i;
  }
  return kept;
};

const makePolyline = (x, y) => {
  const levels = [];
  let kept = Array.from(x, (_, i) => i);
  for (let spacing = 0; ; spacing = spacing === 0 ? .1 : 3 * spacing) {
    if (spacing > 0) kept = thinned(x, y, kept, spacing);
    levels.push({ spacing, kept: Int32Array.from(kept), boxes: boxesOf(x, y, kept) });
    if (kept.length < 500) return { x, y, levels };
  }
};

const overlaps = (a, b) => a[0] <= b[1] && a[1] >= b[0] && a[2] <= b[3] && a[3] >= b[2];

// Appends the points [from, to] of the line to the path of a canvas.
const tracePolyline = (context, polyline, camera, from, to) => {
  const { x, y, levels } = polyline;
  let level = levels[0];
  for (const coarser of levels) if (coarser.spacing * camera.scale <= 1.5) level = coarser;
  const { kept, boxes } = level;
  const view = viewOf(camera, 4);
  const move = (i) => context.moveTo(toScreenX(camera, x[i]), toScreenY(camera, y[i]));
  const draw = (i) => context.lineTo(toScreenX(camera, x[i]), toScreenY(camera, y[i]));
  let next = lastAtMost(kept, from) + 1;
  const end = lastAtMost(kept, to) + 1;
  move(from);
  let seen = true;
  while (next < end) {
    const stretch = Math.floor(Math.max(next - 1, 0) / points_of_stretch);
    const stop = Math.min(end, (stretch + 1) * points_of_stretch + 1);
    if (overlaps(boxes[stretch], view)) {
      if (!seen) move(kept[next - 1]);
      for (let i = next; i < stop; i++) draw(kept[i]);
      seen = true;
    } else {
      seen = false;
    }
    next = stop;
  }
  if (!seen && end > 0) move(kept[end - 1]);
  draw(to);
};
