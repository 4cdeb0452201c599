// The ground that is driven on, and the ways of vehicle and truth.
const niceLength = (metres_) => {
  const power = 10 ** Math.floor(Math.log10(metres_));
  return [5, 2, 1].map((digit) => digit * power).find((length) => length <= metres_);
};

const drawGrid = ({ context, camera, palette }) => {
  const cell = niceLength(160 / camera.scale);
  const [x0, x1, y0, y1] = viewOf(camera);
  stroke(context, palette.grid, 1, () => {
    for (let x = Math.ceil(x0 / cell) * cell; x <= x1; x += cell) {
      context.moveTo(toScreenX(camera, x), 0);
      context.lineTo(toScreenX(camera, x), camera.height);
    }
    for (let y = Math.ceil(y0 / cell) * cell; y <= y1; y += cell) {
      context.moveTo(0, toScreenY(camera, y));
      context.lineTo(camera.width, toScreenY(camera, y));
    }
  });
};

const lengthText = (length) => {
  if (length >= 1000) return `${length / 1000} km`;
  return length >= 1 ? `${length} m` : `${Math.round(100 * length)} cm`;
};

const drawScaleBar = ({ context, camera, palette }) => {
  const length = niceLength(120 / camera.scale);
  const y = camera.height - 14;
  stroke(context, palette.ink, 2, () => {
    context.moveTo(12, y);
    context.lineTo(12 + length * camera.scale, y);
  });
  context.fillStyle = palette.ink;
  context.font = "12px system-ui, sans-serif";
  context.fillText(lengthText(length), 12, y - 6);
};

// The path to come, faint under what is drawn of it later.
const drawComing = ({ context, camera, palette, drive, lines }) => {
  context.globalAlpha = .25;
  stroke(context, palette.faint, 1, () => tracePolyline(context, lines.path, camera, 0, drive.count - 1));
  context.globalAlpha = 1;
};

// The path from scan `first` to scan `end`, in the colour of the mode.
const drawPath = (scene, first, end) => {
  const { context, camera, palette, lines, stretches } = scene;
  for (let s = Math.max(0, lastAtMost(stretches.from, first)); s < stretches.from.length && stretches.from[s] <= end; s++) {
    if (stretches.to[s] < first) continue;
    const searching = stretches.searching[s] === 1;
    stroke(context, searching ? palette.other : palette.estimate, searching ? 3 : 2, () => tracePolyline(
      context, lines.path, camera, Math.max(first, stretches.from[s]), Math.min(end, stretches.to[s])));
  }
  drawLeaps(scene, first, end);
};

// Where closings moved the vehicle.
const drawLeaps = ({ context, camera, palette, drive, leaps }, first, end) => {
  const begin = lastAtMost(leaps, first) + 1, stop = lastAtMost(leaps, end) + 1;
  if (begin === stop) return;
  stroke(context, palette.faint, 1, () => {
    for (const leap of leaps.subarray(begin, stop)) {
      context.moveTo(toScreenX(camera, drive.x[leap - 1]), toScreenY(camera, drive.y[leap - 1]));
      context.lineTo(toScreenX(camera, drive.x[leap]), toScreenY(camera, drive.y[leap]));
    }
  }, [3, 4]);
};

// Not over gaps, as of a satellite receiver that saw nothing.
const drawTruePath = ({ context, camera, palette, drive: { truth, t }, lines, show }, first, end) => {
  if (!truth || !show.truth) return;
  const from = Math.max(0, lastAtMost(truth.t, t[first])), to = lastAtMost(truth.t, t[end]);
  if (to <= from) return;
  stroke(context, palette.truth, 1.3, () => {
    for (let s = lastAtMost(truth.begins, from); s < truth.begins.length && truth.begins[s] < to; s++) {
      const stop = s + 1 < truth.begins.length ? truth.begins[s + 1] - 1 : truth.t.length - 1;
      tracePolyline(context, lines.truth, camera, Math.max(from, truth.begins[s]), Math.min(to, stop));
    }
  });
};

const drawTrueLandmarks = ({ context, camera, palette, show, drive, cells }) => {
  if (!show.truth || !drive.trueLandmarks) return;
  const { x, y } = drive.trueLandmarks;
  const radius = Math.min(6, Math.max(1.2, camera.scale));
  const [x0, x1, y0, y1] = viewOf(camera, radius);
  setCells(cells, camera, 2);
  context.globalAlpha = radius < 2 ? .5 : 1;
  stroke(context, palette.truth, 1, () => {
    for (let i = 0; i < x.length; i++) {
      const inside = x[i] >= x0 && x[i] <= x1 && y[i] >= y0 && y[i] <= y1;
      if (inside && takeCell(cells, x[i], y[i])) circle(context, toScreenX(camera, x[i]), toScreenY(camera, y[i]), radius);
    }
  });
  context.globalAlpha = 1;
};

const drawFinal = ({ context, camera, palette, drive, lines, show }) => {
  if (!drive.final || !show.final) return;
  stroke(context, palette.landmark, 1.3, () => tracePolyline(context, lines.final, camera, 0, drive.count - 1), [6, 4]);
};
