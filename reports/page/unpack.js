// Reads what reports/src/player/packed.cpp wrote: zigzag numbers in bytes of seven bits, in base64, `order` times summed up.
const bytesOf = (text) => {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = letters.charCodeAt(i);
  return bytes;
};

const countNumbers = (bytes) => {
  let count_ = 0;
  for (let i = 0; i < bytes.length; i++) if (bytes[i] < 128) count_++;
  return count_;
};

// Into an array that the caller makes of their number. Differences may need more than 32 bits, numbers do not.
const unpackInto = (Numbers, text, order, unit) => {
  const bytes = bytesOf(text);
  const numbers = new Numbers(countNumbers(bytes));
  let sum = 0, sumOfSums = 0;
  for (let i = 0, filled = 0; i < bytes.length; filled++) {
    let value = bytes[i] & 127;
    for (let scale = 128; bytes[i++] >= 128; scale *= 128) value += (bytes[i] & 127) * scale;
    value = value % 2 === 0 ? value / 2 : -(value + 1) / 2;
    if (order > 0) value = sum += value;
    if (order > 1) value = sumOfSums += value;
    numbers[filled] = value * unit;
  }
  return numbers;
};
const unpack = (text, order) => unpackInto(Int32Array, text, order, 1);
const unpackScaled = (text, order, unit) => unpackInto(Float64Array, text, order, unit);
const unpackMetres = (text, order) => unpackScaled(text, order, .01);

// Ellipses of one σ: half axes in 24ths of a doubling from 1 mm (0: none), angles in 64ths of half a turn.
const axis_lengths = Float32Array.from({ length: 1024 }, (_, steps) => (steps > 0 ? .001 * 2 ** (steps / 24) : 0));
const axisLengths = (steps, less) => {
  const lengths = new Float32Array(steps.length);
  for (let i = 0; i < steps.length; i++) lengths[i] = axis_lengths[Math.min(steps[i] - (less ? less[i] : 0), axis_lengths.length - 1)];
  return lengths;
};
const unpackEllipses = (packed) => {
  const longer = unpack(packed.a, 1);
  return {
    a: axisLengths(longer), b: axisLengths(longer, unpack(packed.b_less, 0)),
    angle: unpackInto(Float32Array, packed.angle, 1, Math.PI / 64),
  };
};

// Where the items of each entry begin; one more than there are entries.
const offsetsOf = (counts) => {
  const offsets = new Int32Array(counts.length + 1);
  for (let i = 0; i < counts.length; i++) offsets[i + 1] = offsets[i] + counts[i];
  return offsets;
};

// The last index in [from, to) whose number is at most `value`; from - 1 when there is none.
const lastAtMost = (numbers, value, from = 0, to = numbers.length) => {
  while (from < to) {
    const middle = (from + to) >> 1;
    if (numbers[middle] <= value) from = middle + 1;
    else to = middle;
  }
  return from - 1;
};
