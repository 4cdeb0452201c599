// One picture of the drive: what the navigator knew after scan k.
const sigmas_of_95 = 2.4477;  // {e : eᵀP⁻¹e = 5.99} in the plane

const circle = (context, x, y, radius) => {
  context.moveTo(x + radius, y);
  context.arc(x, y, radius, 0, 2 * Math.PI);
};

const strokeAs = (context, colour, width, dash = []) => {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.setLineDash(dash);
};

const stroke = (context, colour, width, trace, dash) => {
  strokeAs(context, colour, width, dash);
  context.beginPath();
  trace();
  context.stroke();
};

const traceEllipse = (context, camera, x, y, ellipse, i) => {
  const scale = sigmas_of_95 * camera.scale;
  const a = ellipse.a[i] * scale, b = ellipse.b[i] * scale, angle = -ellipse.angle[i];
  const px = toScreenX(camera, x), py = toScreenY(camera, y);
  context.moveTo(px + a * Math.cos(angle), py + a * Math.sin(angle));
  context.ellipse(px, py, a, b, angle, 0, 2 * Math.PI);
};

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

const drawScaleBar = ({ context, camera, palette }) => {
  const length = niceLength(120 / camera.scale);
  const y = camera.height - 14;
  stroke(context, palette.ink, 2, () => {
    context.moveTo(12, y);
    context.lineTo(12 + length * camera.scale, y);
  });
  context.fillStyle = palette.ink;
  context.font = "12px system-ui, sans-serif";
  context.fillText(length >= 1 ? `${length} m` : `${Math.round(100 * length)} cm`, 12, y - 6);
};

// The path to come, faint under what is drawn of it later.
const drawComing = ({ context, camera, palette, drive, lines }) => {
  context.globalAlpha = .25;
  stroke(context, palette.faint, 1, () => tracePolyline(context, lines.path, camera, 0, drive.count - 1));
  context.globalAlpha = 1;
};

// The path from one scan to the present one, in the colour of the mode.
const drawPath = (scene, first) => {
  const { context, camera, palette, lines, k } = scene;
  for (const { from, to, mode } of scene.stretches) {
    if (to < first) continue;
    if (from > k) break;
    stroke(context, mode === 1 ? palette.other : palette.estimate, mode === 1 ? 3 : 2,
           () => tracePolyline(context, lines.path, camera, Math.max(first, from), Math.min(k, to)));
  }
  drawLeaps(scene, first);
};

// Where closings moved the vehicle.
const drawLeaps = ({ context, camera, palette, drive, leaps, k }, first) => stroke(context, palette.faint, 1, () => {
  for (const leap of leaps) {
    if (leap > k) break;
    if (leap < first) continue;
    context.moveTo(toScreenX(camera, drive.x[leap - 1]), toScreenY(camera, drive.y[leap - 1]));
    context.lineTo(toScreenX(camera, drive.x[leap]), toScreenY(camera, drive.y[leap]));
  }
}, [3, 4]);

const drawTruePath = ({ context, camera, palette, drive, lines, show, t }, first) => {
  if (!drive.truth || !show.truth) return;
  const from = Math.max(0, lastAtMost(drive.truth.t, drive.t[first])), to = lastAtMost(drive.truth.t, t);
  if (to > from) stroke(context, palette.truth, 1.3, () => tracePolyline(context, lines.truth, camera, from, to));
};

const drawTrueLandmarks = ({ context, camera, palette, show }) => {
  if (!show.truth) return;
  const view = viewOf(camera, 8);
  const radius = Math.min(6, Math.max(2.5, camera.scale));
  stroke(context, palette.truth, 1, () => {
    for (const [, x, y] of data.true_landmarks) {
      if (inView(view, x, y)) circle(context, toScreenX(camera, x), toScreenY(camera, y), radius);
    }
  });
};

const drawFinal = ({ context, camera, palette, drive, lines, show }) => {
  if (!drive.final || !show.final) return;
  stroke(context, palette.landmark, 1.3, () => tracePolyline(context, lines.final, camera, 0, drive.count - 1), [6, 4]);
};

// Landmarks on the map at scan k that are in view: [index, place].
const landmarksInView = ({ drive, camera, k }) => {
  const view = viewOf(camera, 12);
  const found = [];
  for (let i = 0; i < drive.landmarks.id.length; i++) {
    const place = placeAt(drive.landmarks, i, k);
    if (place >= 0 && inView(view, drive.landmarks.x[place], drive.landmarks.y[place])) found.push([i, place]);
  }
  return found;
};

const drawLandmarkKind = (scene, chosen, colour, filled) => {
  const { context, camera, drive: { landmarks } } = scene;
  const radius = Math.min(4, Math.max(1.5, camera.scale * .4));
  stroke(context, colour, 1, () => {
    for (const [, place] of chosen) {
      if (landmarks.a[place] * sigmas_of_95 * camera.scale > Math.max(5, radius)) {
        traceEllipse(context, camera, landmarks.x[place], landmarks.y[place], landmarks, place);
      }
    }
  });
  context.beginPath();
  for (const [, place] of chosen) {
    const x = toScreenX(camera, landmarks.x[place]), y = toScreenY(camera, landmarks.y[place]);
    if (radius > 2) circle(context, x, y, radius);
    else context.rect(x - radius, y - radius, 2 * radius, 2 * radius);
  }
  if (filled) {
    context.fillStyle = colour;
    context.fill();
  } else {
    strokeAs(context, colour, 1.2);
    context.stroke();
  }
};

const scans_of_birth = 15;

const drawLandmarks_ = (scene) => {
  const { context, camera, palette, drive: { landmarks }, k, show } = scene;
  const found = landmarksInView(scene);
  drawLandmarkKind(scene, found.filter(([, place]) => landmarks.state[place] !== 1), palette.faint, false);
  drawLandmarkKind(scene, found.filter(([, place]) => landmarks.state[place] === 1), palette.landmark, true);
  stroke(context, palette.estimate, 1.5, () => {
    for (const [i, place] of found) {
      const age = k - landmarks.step[landmarks.offsets[i]];
      if (age < 0 || age >= scans_of_birth) continue;
      circle(context, toScreenX(camera, landmarks.x[place]), toScreenY(camera, landmarks.y[place]), 5 + age);
    }
  });
  if (!show.ids) return;
  context.fillStyle = palette.ink;
  context.font = "11px system-ui, sans-serif";
  for (const [i, place] of found.slice(0, 400)) {
    context.fillText(landmarks.id[i], toScreenX(camera, landmarks.x[place]) + 6, toScreenY(camera, landmarks.y[place]) - 5);
  }
};

// For a while after a merge, from where the landmark that went was to the one that stayed.
const drawMerges = (scene) => {
  const { context, camera, palette, drive, k } = scene;
  const scans_of_merge = 40;
  const { merges, landmarks } = drive;
  stroke(context, palette.bad, 2, () => {
    for (let m = lastAtMost(merges.step, k); m >= 0 && k - merges.step[m] < scans_of_merge; m--) {
      const kept = landmarks.index.get(merges.kept[m]), removed = landmarks.index.get(merges.removed[m]);
      if (kept === undefined || removed === undefined) continue;
      const to = placeAt(landmarks, kept, k);
      const from = lastAtMost(landmarks.step, merges.step[m] - 1, landmarks.offsets[removed], landmarks.offsets[removed + 1]);
      if (to < 0 || from < landmarks.offsets[removed]) continue;
      context.moveTo(toScreenX(camera, landmarks.x[from]), toScreenY(camera, landmarks.y[from]));
      context.lineTo(toScreenX(camera, landmarks.x[to]), toScreenY(camera, landmarks.y[to]));
      circle(context, toScreenX(camera, landmarks.x[to]), toScreenY(camera, landmarks.y[to]), 8);
    }
  });
};

// The observations of scan k: {outcome, landmark, sx, sy (where seen, on screen), lx, ly (its landmark), or NaN}.
const observationsOf = ({ drive, camera, pose, k }) => {
  const { scans, landmarks } = drive;
  const scan = Math.floor(k / scans.stride);
  const cos = Math.cos(pose.heading), sin = Math.sin(pose.heading);
  const seen = [];
  for (let i = scans.offsets[scan]; i < scans.offsets[scan + 1]; i++) {
    const index = landmarks.index.get(scans.landmark[i]);
    const place = index === undefined ? -1 : placeAt(landmarks, index, k);
    const x = pose.x + cos * scans.x[i] - sin * scans.y[i], y = pose.y + sin * scans.x[i] + cos * scans.y[i];
    seen.push({
      outcome: scans.outcome[i], sx: toScreenX(camera, x), sy: toScreenY(camera, y),
      lx: place < 0 ? NaN : toScreenX(camera, landmarks.x[place]),
      ly: place < 0 ? NaN : toScreenY(camera, landmarks.y[place]),
    });
  }
  return seen;
};

const drawScan = (scene) => {
  const { context, camera, palette, pose } = scene;
  const colour = [palette.landmark, palette.estimate, palette.truth, palette.bad];
  const px = toScreenX(camera, pose.x), py = toScreenY(camera, pose.y);
  for (const one of observationsOf(scene)) {
    const seen = !Number.isNaN(one.sx);
    const to = seen ? [one.sx, one.sy] : [one.lx, one.ly];
    context.globalAlpha = .6;
    stroke(context, colour[one.outcome], 1, () => {
      context.moveTo(px, py);
      context.lineTo(...to);
    }, one.outcome === outcome.matched ? [] : [4, 3]);
    context.globalAlpha = 1;
    stroke(context, colour[one.outcome], 2, () => {
      if (seen && one.outcome === outcome.matched && !Number.isNaN(one.lx)) {
        context.moveTo(one.sx, one.sy);
        context.lineTo(one.lx, one.ly);
      }
      if (one.outcome === outcome.matched) circle(context, ...to, 5);
      else cross(context, ...to, 4);
    });
  }
};

const cross = (context, x, y, half) => {
  context.moveTo(x - half, y - half);
  context.lineTo(x + half, y + half);
  context.moveTo(x - half, y + half);
  context.lineTo(x + half, y - half);
};

// Particles of the search that goes on: the last cloud kept of it.
const drawCloud = ({ context, camera, palette, drive, k }) => {
  const { clouds } = drive;
  const cloud = lastAtMost(clouds.step, k + drive.firstStep);
  if (cloud < 0) return;
  const at = clouds.step[cloud] - drive.firstStep;
  const ended = k > at && !searchingAt(drive, k);
  if (ended && k - at > 5) return;
  const length = Math.max(7, 1.2 * camera.scale);
  stroke(context, palette.ink, 1, () => {
    for (let i = clouds.offsets[cloud]; i < clouds.offsets[cloud + 1]; i++) {
      const x = toScreenX(camera, clouds.x[i]), y = toScreenY(camera, clouds.y[i]);
      context.moveTo(x, y);
      context.lineTo(x + length * Math.cos(clouds.heading[i]), y - length * Math.sin(clouds.heading[i]));
    }
  });
};

const drawArrowhead = (context, x, y, heading, size) => {
  const corner = (along, aside) => [
    x + size * (along * Math.cos(heading) - aside * Math.sin(heading)),
    y - size * (along * Math.sin(heading) + aside * Math.cos(heading))];
  context.beginPath();
  context.moveTo(...corner(1, 0));
  for (const [along, aside] of [[-.7, .6], [-.35, 0], [-.7, -.6]]) context.lineTo(...corner(along, aside));
  context.closePath();
};

const drawVehicle = ({ context, camera, palette, drive, pose, k, t, show }) => {
  const colour = searchingAt(drive, k) ? palette.other : palette.estimate;
  const size = Math.max(9, 1.5 * camera.scale);
  stroke(context, colour, 1.5, () => traceEllipse(context, camera, pose.x, pose.y, drive.ellipse, k));
  drawArrowhead(context, toScreenX(camera, pose.x), toScreenY(camera, pose.y), pose.heading, size);
  context.fillStyle = colour;
  context.fill();
  strokeAs(context, palette.paper, 1);
  context.stroke();
  const truth = show.truth && drive.truth && truthAt(drive.truth, t);
  if (!truth) return;
  stroke(context, palette.truth, 2,
         () => circle(context, toScreenX(camera, truth[0]), toScreenY(camera, truth[1]), Math.max(5, .6 * size)));
};

// Closings made so far, where the vehicle then was: accepted a tick, refused a cross, undecided a ring, new ground a diamond.
const drawClosings = ({ context, camera, palette, closings, k, drive }) => {
  const colour = { accepted: palette.landmark, refused: palette.bad, undecided: palette.faint };
  for (const closing of closings) {
    if (closing.step - drive.firstStep > k) break;
    const x = toScreenX(camera, closing.x), y = toScreenY(camera, closing.y);
    stroke(context, colour[closing.verdict] || palette.faint, 2.5, () => {
      if (closing.verdict === "refused") cross(context, x, y, 5);
      else if (closing.verdict === "accepted") {
        context.moveTo(x - 6, y);
        context.lineTo(x - 1, y + 5);
        context.lineTo(x + 7, y - 6);
      } else if (closing.verdict === "new-ground") {
        context.moveTo(x, y - 7);
        for (const [dx, dy] of [[7, 0], [0, 7], [-7, 0], [0, -7]]) context.lineTo(x + dx, y + dy);
      } else circle(context, x, y, 6);
    });
  }
};

const drawScene = (scene) => {
  const { context, camera, palette } = scene;
  context.globalAlpha = 1;
  context.fillStyle = palette.paper;
  context.fillRect(0, 0, camera.width, camera.height);
  for (const draw_ of [drawWays, drawLandmarks_, drawMerges, drawScan, drawCloud, drawVehicle, drawClosings, drawScaleBar]) {
    draw_(scene);
  }
  context.setLineDash([]);
};
