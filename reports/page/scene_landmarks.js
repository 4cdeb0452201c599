// Landmarks as they were known at scan k.
const landmarkRadius = (camera) => Math.min(4, Math.max(1.5, camera.scale * .4));

// Places in view, the nearer to the beginning of the drive first: scene.visible[0 … count of them].
const findVisible = ({ camera, present: { place, landmarks }, visible }) => {
  const [x0, x1, y0, y1] = viewOf(camera, 12);
  let found = 0;
  for (let i = 0; i < place.length; i++) {
    const p = place[i];
    if (p < 0) continue;
    const x = landmarks.x[p], y = landmarks.y[p];
    if (x >= x0 && x <= x1 && y >= y0 && y <= y1) visible[found++] = p;
  }
  return found;
};

const tracePlaces = ({ context, camera, present: { landmarks }, visible }, found, mature, radius) => {
  context.beginPath();
  for (let v = 0; v < found; v++) {
    const p = visible[v];
    if ((landmarks.mature[p] === 1) === mature) {
      circle(context, toScreenX(camera, landmarks.x[p]), toScreenY(camera, landmarks.y[p]), radius);
    }
  }
};

const drawNearLandmarks = (scene, found, radius) => {
  const { context, palette } = scene;
  tracePlaces(scene, found, false, radius);
  strokeAs(context, palette.faint, 1.2);
  context.stroke();
  tracePlaces(scene, found, true, radius);
  context.fillStyle = palette.landmark;
  context.fill();
};

// Ellipses that can be seen around their landmark. Of such as would cover each other one is drawn in each cell: [half axis in pixels from,
// to, width of a cell].
const ellipse_sizes = [[5, 24, 16], [24, 80, 64], [80, Infinity, 240]];

const traceEllipses = ({ context, camera, present: { landmarks }, visible, cells }, found, from_m, to_m, mature) => {
  for (let v = 0; v < found; v++) {
    const p = visible[v];
    if (landmarks.a[p] <= from_m || landmarks.a[p] > to_m || (landmarks.mature[p] === 1) !== mature) continue;
    if (takeCell(cells, landmarks.x[p], landmarks.y[p])) traceEllipse(context, camera, landmarks.x[p], landmarks.y[p], landmarks, p);
  }
};

const drawLandmarkEllipses = (scene, found) => {
  const { context, camera, palette, cells } = scene;
  const pixels_of_sigma = sigmas_of_95 * camera.scale;
  context.globalAlpha = .6;
  for (const [from, to, width] of ellipse_sizes) {
    setCells(cells, camera, width);
    for (const mature of [true, false]) {
      stroke(context, mature ? palette.landmark : palette.faint, 1, () =>
        traceEllipses(scene, found, from / pixels_of_sigma, to / pixels_of_sigma, mature));
    }
  }
  context.globalAlpha = 1;
};

const scans_of_birth = 15;

// A ring around each landmark that was born in the last scans.
const drawBirths = ({ context, camera, palette, k, present: { events, owner, next, place, landmarks }, cells }) => {
  setCells(cells, camera, 12);
  stroke(context, palette.estimate, 1.5, () => {
    for (let e = next - 1; e >= 0 && k - events.step[e] < scans_of_birth; e--) {
      const born = events.what[e];
      if (born < 0 || born !== landmarks.offsets[owner[born]]) continue;
      const p = place[owner[born]];
      if (p < 0 || !takeCell(cells, landmarks.x[p], landmarks.y[p])) continue;
      circle(context, toScreenX(camera, landmarks.x[p]), toScreenY(camera, landmarks.y[p]), 5 + k - events.step[e]);
    }
  });
};

const drawIds = ({ context, camera, palette, present: { owner, landmarks }, visible, cells }, found) => {
  context.fillStyle = palette.ink;
  context.font = "11px system-ui, sans-serif";
  setCells(cells, camera, 32);
  for (let v = 0; v < found; v++) {
    const p = visible[v];
    if (!takeCell(cells, landmarks.x[p], landmarks.y[p])) continue;
    context.fillText(shortName(landmarks.id[owner[p]]), toScreenX(camera, landmarks.x[p]) + 6, toScreenY(camera, landmarks.y[p]) - 5);
  }
};

const drawLandmarks_ = (scene) => {
  const radius = landmarkRadius(scene.camera);
  const far = radius <= 2;
  if (far) {
    drawFarLandmarks(scene, radius);
  } else {
    showPresent(scene.present, scene.k);
    scene.ink.look = "";
  }
  const found = findVisible(scene);
  drawLandmarkEllipses(scene, found);
  if (!far) drawNearLandmarks(scene, found, radius);
  drawBirths(scene);
  if (scene.show.ids) drawIds(scene, found);
};

// For a while after a merge, from where the landmark that went was to the one that stayed.
const drawMerges = ({ context, camera, palette, drive: { merges, landmarks }, present: { place }, k }) => {
  const scans_of_merge = 40;
  stroke(context, palette.bad, 2, () => {
    for (let m = lastAtMost(merges.step, k); m >= 0 && k - merges.step[m] < scans_of_merge; m--) {
      const kept = indexOf(landmarks, merges.kept[m]), removed = indexOf(landmarks, merges.removed[m]);
      if (kept < 0 || removed < 0) continue;
      const to = place[kept];
      const from = lastAtMost(landmarks.step, merges.step[m] - 1, landmarks.offsets[removed], landmarks.offsets[removed + 1]);
      if (to < 0 || from < landmarks.offsets[removed]) continue;
      const x = toScreenX(camera, landmarks.x[to]), y = toScreenY(camera, landmarks.y[to]);
      context.moveTo(toScreenX(camera, landmarks.x[from]), toScreenY(camera, landmarks.y[from]));
      context.lineTo(x, y);
      circle(context, x, y, 8);
    }
  });
};
