// The drive as the player replays it: typed arrays by scan. Lengths in metres, headings in radians, times in seconds since the
// first scan.
const outcome = { matched: 0, augmented: 1, ambiguous: 2, rejected: 3 };

const unpackPoses = (packed) => ({
  x: unpackMetres(packed.x, 1), y: unpackMetres(packed.y, 1), heading: scaled(unpack(packed.heading, 1), .001),
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

const unpackLandmarks = (packed) => {
  const id = unpack(packed.id, 1);
  return {
    id, until: unpack(packed.until, 1), offsets: offsetsOf(unpack(packed.count, 0)), step: unpack(packed.step, 1),
    x: unpackMetres(packed.x, 1), y: unpackMetres(packed.y, 1), state: unpack(packed.state, 0),
    ...unpackEllipses(packed), index: new Map(Array.from(id, (name, i) => [name, i])),
  };
};

const unpackClouds = (packed) => ({
  step: unpack(packed.step, 1), offsets: offsetsOf(unpack(packed.count, 1)), x: unpackMetres(packed.x, 1),
  y: unpackMetres(packed.y, 1), heading: scaled(unpack(packed.heading, 1), .001),
});

const unpackTruth = (packed) => packed && {
  t: scaled(unpack(packed.t, 2), .001), x: unpackMetres(packed.x, 1), y: unpackMetres(packed.y, 1),
  aligned: packed.aligned,
};

const unpackMerges = (packed) => ({
  step: unpack(packed.step, 1), kept: unpack(packed.kept, 1), removed: unpack(packed.removed, 1),
});

const unpackDrive = (packed) => ({
  scans: unpackScans(packed.scans),
  begin_s: packed.begin_s,
  firstStep: packed.first_step,
  count: packed.steps,
  t: scaled(unpack(packed.path.t, 2), .001),
  ...unpackPoses(packed.path),
  ellipse: unpackEllipses(packed.path),
  final: packed.final && unpackPoses(packed.final),
  modes: packed.modes,
  landmarks: unpackLandmarks(packed.landmarks),
  merges: unpackMerges(packed.merges),
  truth: unpackTruth(packed.truth),
  clouds: unpackClouds(packed.clouds),
});

// Stretches of the path in one mode and without a leap: {from, to, mode}; a leap is the scan of an accepted closing.
const stretchesOf = (drive, leaps) => {
  const begins = [...new Set([...drive.modes.map(([from]) => from), ...leaps])].sort((a, b) => a - b);
  return begins.map((from, i) => {
    const next = begins[i + 1];
    const to = next === undefined ? drive.count - 1 : leaps.includes(next) ? next - 1 : next;
    return { from, to, mode: searchingAt(drive, from) ? 1 : 0 };
  });
};

const searchingAt = (drive, k) => drive.modes.reduce((mode, [from, value]) => (from <= k ? value : mode), 0) === 1;

// The place of a landmark at scan k: an index into landmarks.x, …; -1 when it is not on the map then.
const placeAt = (landmarks, i, k) => {
  if (landmarks.until[i] >= 0 && k >= landmarks.until[i]) return -1;
  const from = landmarks.offsets[i];
  const found = lastAtMost(landmarks.step, k, from, landmarks.offsets[i + 1]);
  return found < from ? -1 : found;
};

// Where the truth is at a time: between two positions at most 3 s apart.
const truthAt = (truth, t) => {
  const i = lastAtMost(truth.t, t);
  if (i < 0 || t - truth.t[i] > 3) return null;
  if (i + 1 >= truth.t.length || truth.t[i + 1] - truth.t[i] > 3) {
    return t - truth.t[i] < .05 ? [truth.x[i], truth.y[i]] : null;
  }
  const part = (t - truth.t[i]) / (truth.t[i + 1] - truth.t[i]);
  return [truth.x[i] + part * (truth.x[i + 1] - truth.x[i]), truth.y[i] + part * (truth.y[i + 1] - truth.y[i])];
};
