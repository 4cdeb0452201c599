// What there is at the time of the player: the vehicle, what it sees, its search.

// Where an observation of the scan is on screen, into `seen`: {sx, sy (where it was seen), lx, ly (its landmark)}, NaN where unknown.
const locate = ({ drive: { scans, landmarks }, present, camera, pose }, i, seen) => {
  const cos = Math.cos(pose.heading), sin = Math.sin(pose.heading);
  const index = indexOf(landmarks, scans.landmark[i]);
  const place = index < 0 ? -1 : present.place[index];
  seen.sx = toScreenX(camera, pose.x + cos * scans.x[i] - sin * scans.y[i]);
  seen.sy = toScreenY(camera, pose.y + sin * scans.x[i] + cos * scans.y[i]);
  seen.lx = place < 0 ? NaN : toScreenX(camera, landmarks.x[place]);
  seen.ly = place < 0 ? NaN : toScreenY(camera, landmarks.y[place]);
};

const seen_now = { sx: NaN, sy: NaN, lx: NaN, ly: NaN };

// visit(x, y, seen) for each observation of the scan with the outcome, and where it is on screen.
const forObservations = (scene, wanted, visit) => {
  const { scans } = scene.drive;
  const scan = Math.floor(scene.k / scans.stride);
  for (let i = scans.offsets[scan]; i < scans.offsets[scan + 1]; i++) {
    if (scans.outcome[i] !== wanted) continue;
    locate(scene, i, seen_now);
    const point = !Number.isNaN(seen_now.sx);
    const x = point ? seen_now.sx : seen_now.lx, y = point ? seen_now.sy : seen_now.ly;
    if (!Number.isNaN(x)) visit(x, y, seen_now);
  }
};

const dashes = [4, 3];

const drawOutcome = (scene, wanted, colour) => {
  const { context, camera, pose } = scene;
  const matched = wanted === outcome.matched;
  const px = toScreenX(camera, pose.x), py = toScreenY(camera, pose.y);
  context.globalAlpha = .6;
  stroke(context, colour, 1, () => forObservations(scene, wanted, (x, y) => {
    context.moveTo(px, py);
    context.lineTo(x, y);
  }), matched ? undefined : dashes);
  context.globalAlpha = 1;
  stroke(context, colour, 2, () => forObservations(scene, wanted, (x, y, seen) => {
    if (!matched) {
      cross(context, x, y, 4);
      return;
    }
    if (!Number.isNaN(seen.lx)) {
      context.moveTo(x, y);
      context.lineTo(seen.lx, seen.ly);
    }
    circle(context, x, y, 5);
  }));
};

const drawScan = (scene) => {
  const { palette } = scene;
  drawOutcome(scene, outcome.matched, palette.landmark);
  drawOutcome(scene, outcome.augmented, palette.estimate);
  drawOutcome(scene, outcome.ambiguous, palette.truth);
  drawOutcome(scene, outcome.rejected, palette.bad);
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

// Marks of closings: accepted a tick, refused a cross, new ground a diamond, anything else a ring.
const closingMarks = {
  accepted: (context, x, y) => {
    context.moveTo(x - 6, y);
    context.lineTo(x - 1, y + 5);
    context.lineTo(x + 7, y - 6);
  },
  refused: (context, x, y) => cross(context, x, y, 5),
  "new-ground": (context, x, y) => {
    context.moveTo(x, y - 7);
    context.lineTo(x + 7, y);
    context.lineTo(x, y + 7);
    context.lineTo(x - 7, y);
    context.lineTo(x, y - 7);
  },
  undecided: (context, x, y) => circle(context, x, y, 6),
};

// Closings made so far, where the vehicle then was.
const drawClosings = ({ context, camera, palette, closings, k, drive }) => {
  const colour = { accepted: palette.landmark, refused: palette.bad };
  for (const verdict of Object.keys(closingMarks)) {
    stroke(context, colour[verdict] || palette.faint, 2.5, () => {
      for (const closing of closings) {
        if (closing.step - drive.firstStep > k) break;
        if ((closing.verdict in closingMarks ? closing.verdict : "undecided") !== verdict) continue;
        closingMarks[verdict](context, toScreenX(camera, closing.x), toScreenY(camera, closing.y));
      }
    });
  }
};
