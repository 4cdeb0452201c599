// The landmarks on the map at a scan, kept as time goes on: of each its place then (an index into landmarks.x, …), or -1. What
// happens to them stands in order of time, so that going on costs what changes, not what there is.

// {step, what}: what >= 0: the landmark of that place is there from now on; what < 0: landmark -1 - what is gone.
const eventsOf = ({ until, step }) => {
  const ends = until.reduce((sum, at) => sum + (at >= 0 ? 1 : 0), 0);
  const total = step.length + ends;
  const steps = new Int32Array(total), what = new Int32Array(total);
  let filled = step.length;
  steps.set(step);
  for (let p = 0; p < step.length; p++) what[p] = p;
  until.forEach((at, i) => {
    if (at < 0) return;
    steps[filled] = at;
    what[filled++] = -1 - i;
  });
  return sortedBySteps(steps, what);
};

// Counting sort: stable, so that a landmark that comes and goes in one scan is gone.
const sortedBySteps = (steps, what) => {
  let most = 0;
  for (let e = 0; e < steps.length; e++) most = Math.max(most, steps[e]);
  const begins = new Int32Array(most + 2);
  for (let e = 0; e < steps.length; e++) begins[Math.max(0, steps[e]) + 1]++;
  for (let s = 0; s <= most; s++) begins[s + 1] += begins[s];
  const sorted = { step: new Int32Array(steps.length), what: new Int32Array(steps.length) };
  for (let e = 0; e < steps.length; e++) {
    const to = begins[Math.max(0, steps[e])]++;
    sorted.step[to] = steps[e];
    sorted.what[to] = what[e];
  }
  return sorted;
};

const ownersOf = (offsets, places) => {
  const owner = new Int32Array(places);
  for (let i = 0; i + 1 < offsets.length; i++) owner.fill(i, offsets[i], offsets[i + 1]);
  return owner;
};

const makePresent = (landmarks) => ({
  landmarks, events: eventsOf(landmarks), owner: ownersOf(landmarks.offsets, landmarks.step.length),
  place: new Int32Array(landmarks.id.length).fill(-1), next: 0, k: -1,
});

const startAgain = (present) => {
  present.place.fill(-1);
  present.next = 0;
  present.k = -1;
};

// Goes on to scan k; says of each landmark that changes where it was and is: onChange(place before, place after).
const goOnTo = (present, k, onChange) => {
  const { events, owner, place, landmarks: { until } } = present;
  for (; present.next < events.step.length && events.step[present.next] <= k; present.next++) {
    const what = events.what[present.next];
    const i = what >= 0 ? owner[what] : -1 - what;
    const gone = what < 0 || (until[i] >= 0 && events.step[present.next] >= until[i]);
    const before = place[i];
    place[i] = gone ? -1 : what;
    if (onChange) onChange(before, place[i]);
  }
  present.k = k;
};

const nothing = () => {};
const showPresent = (present, k) => {
  if (k < present.k) startAgain(present);
  goOnTo(present, k, nothing);
};
