// Reads what reports/src/packed.cpp wrote: zigzag numbers in bytes of seven bits, in base64, `order` times summed up.
const bytesOf = (text) => {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = letters.charCodeAt(i);
  return bytes;
};

const unpack = (text, order) => {
  const bytes = bytesOf(text);
  const numbers = new Int32Array(bytes.reduce((sum, byte) => sum + (byte < 128 ? 1 : 0), 0));
  const before = [0, 0, 0];
  let filled = 0, value = 0, scale = 1;
  for (const byte of bytes) {
    value += (byte & 127) * scale;
    scale *= 128;
    if (byte >= 128) continue;
    let number = value % 2 === 0 ? value / 2 : -(value + 1) / 2;
    for (let k = order - 1; k >= 0; k--) before[k] = number += before[k];
    numbers[filled++] = number;
    value = 0;
    scale = 1;
  }
  return numbers;
};

const scaled = (numbers, unit) => Float64Array.from(numbers, (number) => number * unit);
const unpackMetres = (text, order) => scaled(unpack(text, order), .01);

// Ellipses of one σ: half axes in 24ths of a doubling from 1 mm (0: none), angles in 64ths of half a turn.
const unpackEllipses = (packed) => {
  const axis = (text) => Float32Array.from(unpack(text, 1), (steps) => (steps > 0 ? .001 * 2 ** (steps / 24) : 0));
  return { a: axis(packed.a), b: axis(packed.b), angle: scaled(unpack(packed.angle, 1), Math.PI / 64) };
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
