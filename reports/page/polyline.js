// A long line in levels of detail: level n leaves out points nearer than 0.1·3ⁿ m to the last one kept. Drawn is the level that
// a screen can show, and of it the stretches that are in view.
const points_of_stretch = 64;

// Of each stretch x0, x1, y0, y1, one after the other.
const boxesOf = (x, y, kept) => {
  const boxes = new Float64Array(4 * Math.ceil(kept.length / points_of_stretch));
  for (let begin = 0, b = 0; begin < kept.length; begin += points_of_stretch, b += 4) {
    let x0 = Infinity, x1 = -Infinity, y0 = Infinity, y1 = -Infinity;
    for (let i = begin; i <= Math.min(begin + points_of_stretch, kept.length - 1); i++) {
      const px = x[kept[i]], py = y[kept[i]];
      if (px < x0) x0 = px;
      if (px > x1) x1 = px;
      if (py < y0) y0 = py;
      if (py > y1) y1 = py;
    }
    boxes[b] = x0;
    boxes[b + 1] = x1;
    boxes[b + 2] = y0;
    boxes[b + 3] = y1;
  }
  return boxes;
};

const thinned = (x, y, finer, spacing) => {
  const kept = new Int32Array(finer.length);
  let number = 0, before = -1;
  for (const i of finer) {
    if (before >= 0) {
      const dx = x[i] - x[before], dy = y[i] - y[before];
      if (dx * dx + dy * dy < spacing * spacing) continue;
    }
    kept[number++] = i;
    before = i;
  }
  return kept.slice(0, number);
};

const makePolyline = (x, y) => {
  const levels = [];
  let kept = new Int32Array(x.length).map((_, i) => i);
  for (let spacing = 0; ; spacing = spacing === 0 ? .1 : 3 * spacing) {
    if (spacing > 0) kept = thinned(x, y, kept, spacing);
    levels.push({ spacing, kept, boxes: boxesOf(x, y, kept) });
    if (kept.length < 500) return { x, y, levels };
  }
};

const levelFor = ({ levels }, camera) => {
  let level = levels[0];
  for (const coarser of levels) if (coarser.spacing * camera.scale <= 1.5) level = coarser;
  return level;
};

// Appends the points [from, to] of the line to the path of a canvas.
const tracePolyline = (context, polyline, camera, from, to) => {
  const { x, y } = polyline;
  const { kept, boxes } = levelFor(polyline, camera);
  const { scale } = camera;
  const left = camera.width / 2 - camera.x * scale, top = camera.height / 2 + camera.y * scale;
  const [x0, x1, y0, y1] = viewOf(camera, 4);
  let next = lastAtMost(kept, from) + 1;
  const end = lastAtMost(kept, to) + 1;
  context.moveTo(left + x[from] * scale, top - y[from] * scale);
  let seen = true;
  while (next < end) {
    const stretch = Math.floor(Math.max(next - 1, 0) / points_of_stretch);
    const stop = Math.min(end, (stretch + 1) * points_of_stretch + 1);
    const b = 4 * stretch;
    if (boxes[b] <= x1 && boxes[b + 1] >= x0 && boxes[b + 2] <= y1 && boxes[b + 3] >= y0) {
      if (!seen) context.moveTo(left + x[kept[next - 1]] * scale, top - y[kept[next - 1]] * scale);
      for (let i = next; i < stop; i++) context.lineTo(left + x[kept[i]] * scale, top - y[kept[i]] * scale);
      seen = true;
    } else {
      seen = false;
    }
    next = stop;
  }
  if (!seen && end > 0) context.moveTo(left + x[kept[end - 1]] * scale, top - y[kept[end - 1]] * scale);
  context.lineTo(left + x[to] * scale, top - y[to] * scale);
};
