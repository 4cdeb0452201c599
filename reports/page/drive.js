// The drive as the player replays it: typed arrays by scan. Lengths in metres, headings in radians, times in seconds since the
// first scan.
const outcome = { matched: 0, augmented: 1, ambiguous: 2, rejected: 3 };

const unpackPoses = (packed) => ({
  x: unpackMetres(packed.x, 1), y: unpackMetres(packed.y, 1), heading: unpackScaled(packed.heading, 1, .001),
});

// For each scan kept, its observations: landmark, outcome, and where they were seen from the robot (NaN: no point).
const unpackScans = (packed) => {
  const who = unpack(packed.who, 0);
  const px = unpack(packed.x, 0), py = unpack(packed.y, 0);
  const scans = {
    stride: packed.stride, offsets: offsetsOf(unpack(packed.count, 0)), landmark: new Int32Array(who.length),
    outcome: new Uint8Array(who.length), x: new Float32Array(who.length), y: new Float32Array(who.length),
  };
  let landmark = 0, point = 0;
  for (let i = 0; i < who.length; i++) {
    const low = who[i] & 7;
    landmark += (who[i] - low) / 8;
    const seen = (low & 4) !== 0;
    scans.landmark[i] = landmark;
    scans.outcome[i] = low & 3;
    scans.x[i] = seen ? px[point] * .01 : NaN;
    scans.y[i] = seen ? py[point] * .01 : NaN;
    if (seen) point++;
  }
  return scans;
};

// Steps counted from the first scan; -1: never.
const sinceStep = (steps, firstStep) => {
  for (let i = 0; i < steps.length; i++) steps[i] = steps[i] < 0 ? -1 : steps[i] - firstStep;
  return steps;
};

// A place of a landmark holds from its step on; that number is doubled, plus one where the landmark is mature.
const unpackLandmarks = (packed, firstStep) => {
  const step = unpack(packed.step, 1);
  const mature = new Uint8Array(step.length);
  for (let p = 0; p < step.length; p++) {
    mature[p] = step[p] & 1;
    step[p] >>= 1;
  }
  return {
    id: unpack(packed.id, 1), until: sinceStep(unpack(packed.until, 1), firstStep), offsets: offsetsOf(unpack(packed.count, 0)),
    step: sinceStep(step, firstStep), mature,
    x: unpackMetres(packed.x, 1), y: unpackMetres(packed.y, 1), ...unpackEllipses(packed),
  };
};

// Which landmark has an id (ids ascend); -1: none.
const indexOf = ({ id }, wanted) => {
  const i = lastAtMost(id, wanted);
  return i >= 0 && id[i] === wanted ? i : -1;
};

const unpackClouds = (packed) => ({
  step: unpack(packed.step, 1), offsets: offsetsOf(unpack(packed.count, 1)), x: unpackMetres(packed.x, 1),
  y: unpackMetres(packed.y, 1), heading: unpackScaled(packed.heading, 1, .001),
});

const longest_gap_s = 3;

// With the indices where it begins anew after a gap.
const unpackTruth = (packed) => {
  if (!packed) return null;
  const t = unpackScaled(packed.t, 2, .001);
  const begins = [0];
  for (let i = 1; i < t.length; i++) if (t[i] - t[i - 1] > longest_gap_s) begins.push(i);
  return { t, x: unpackMetres(packed.x, 1), y: unpackMetres(packed.y, 1), aligned: packed.aligned, begins: Int32Array.from(begins) };
};

const unpackMerges = (packed) => ({
  step: unpack(packed.step, 1), kept: unpack(packed.kept, 1), removed: unpack(packed.removed, 1),
});

const unpackDrive = (packed) => ({
  scans: unpackScans(packed.scans),
  begin_s: packed.begin_s,
  firstStep: packed.first_step,
  count: packed.steps,
  t: unpackScaled(packed.path.t, 2, .001),
  ...unpackPoses(packed.path),
  ellipse: unpackEllipses(packed.path),
  final: packed.final && unpackPoses(packed.final),
  modes: unpackModes(packed.modes),
  landmarks: unpackLandmarks(packed.landmarks, packed.first_step),
  merges: unpackMerges(packed.merges),
  truth: unpackTruth(packed.truth),
  trueLandmarks: packed.true_landmarks && { x: unpackMetres(packed.true_landmarks.x, 1), y: unpackMetres(packed.true_landmarks.y, 1) },
  clouds: unpackClouds(packed.clouds),
});

// Stretches of the path in one mode and without a leap; a leap is the scan of an accepted closing.
const stretchesOf = (drive, leaps) => {
  const begins = [...new Set([...drive.modes.from, ...leaps])].sort((a, b) => a - b);
  const leaping = new Set(leaps);
  return {
    from: Int32Array.from(begins),
    to: Int32Array.from(begins, (_, i) => {
      const next = begins[i + 1];
      return next === undefined ? drive.count - 1 : leaping.has(next) ? next - 1 : next;
    }),
    searching: Uint8Array.from(begins, (from) => searchingAt(drive, from)),
  };
};

const unpackModes = (modes) => ({
  from: Int32Array.from(modes, ([from]) => from), searching: Uint8Array.from(modes, ([, mode]) => mode === 1),
});

const searchingAt = ({ modes }, k) => modes.searching[lastAtMost(modes.from, k)] === 1;

// Where the truth is at a time: between two positions without a gap.
const truthAt = (truth, t) => {
  const i = lastAtMost(truth.t, t);
  if (i < 0 || t - truth.t[i] > longest_gap_s) return null;
  if (i + 1 >= truth.t.length || truth.t[i + 1] - truth.t[i] > longest_gap_s) {
    return t - truth.t[i] < .05 ? [truth.x[i], truth.y[i]] : null;
  }
  const part = (t - truth.t[i]) / (truth.t[i + 1] - truth.t[i]);
  return [truth.x[i] + part * (truth.x[i + 1] - truth.x[i]), truth.y[i] + part * (truth.y[i + 1] - truth.y[i])];
};

// Unpacked once, for the player and for the pictures of closures; null of a run without scans.
const theDrive = (() => {
  let drive;
  return () => {
    if (drive === undefined) {
      const packed = parse("player-data");
      drive = packed && unpackDrive(packed);
    }
    return drive;
  };
})();
