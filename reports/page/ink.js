// Landmarks seen from afar, as squares of a few pixels: how many have their middle on each pixel is counted, so that a landmark that comes,
// moves or goes costs its own pixels and not those of a hundred thousand others.
const makeInk = () => ({ canvas: element("canvas"), look: "", width: 0, height: 0, radius: 1, dirty: new Int32Array(4) });

const inkColour = (css) => {
  const [r, g, b] = [1, 3, 5].map((at) => parseInt(css.slice(at, at + 2), 16));
  return new Uint32Array(new Uint8Array([r, g, b, 255]).buffer)[0];
};

const clearInk = (ink, { canvas, palette }, radius) => {
  const { width, height } = canvas;
  if (ink.width !== width || ink.height !== height || !ink.image) {
    [ink.canvas.width, ink.canvas.height] = [ink.width, ink.height] = [width, height];
    ink.image = ink.canvas.getContext("2d").createImageData(width, height);
    ink.pixels = new Uint32Array(ink.image.data.buffer);
    ink.counts = { mature: new Uint32Array(width * height), tentative: new Uint32Array(width * height) };
  }
  ink.pixels.fill(0);
  ink.counts.mature.fill(0);
  ink.counts.tentative.fill(0);
  ink.radius = radius;
  ink.colours = { mature: inkColour(palette.landmark), tentative: inkColour(palette.faint) };
  ink.dirty.set([0, 0, width, height]);
};

// The pixel of a place, or -1 out of the picture.
const pixelOf = (ink, view, landmarks, place) => {
  const px = Math.floor((landmarks.x[place] - view.x) * view.scale), py = Math.floor((view.y - landmarks.y[place]) * view.scale);
  return px < 0 || py < 0 || px >= ink.width || py >= ink.height ? -1 : py * ink.width + px;
};

const nearPixel = (ink, pixel, visit) => {
  const { width, height, radius } = ink;
  const px = pixel % width, py = (pixel - px) / width;
  const x0 = Math.max(0, px - radius), x1 = Math.min(width - 1, px + radius);
  const y0 = Math.max(0, py - radius), y1 = Math.min(height - 1, py + radius);
  for (let y = y0; y <= y1; y++) for (let at = y * width + x0; at <= y * width + x1; at++) if (visit(at)) return true;
  return false;
};

const soil = (ink, pixel) => {
  const { dirty, width, radius } = ink;
  const px = pixel % width, py = (pixel - px) / width;
  dirty[0] = Math.min(dirty[0], px - radius);
  dirty[1] = Math.min(dirty[1], py - radius);
  dirty[2] = Math.max(dirty[2], px + radius + 1);
  dirty[3] = Math.max(dirty[3], py + radius + 1);
};

const addInk = (ink, pixel, mature) => {
  const { pixels, colours, width, height, radius } = ink;
  const counts = mature ? ink.counts.mature : ink.counts.tentative;
  if (counts[pixel]++ > 0) return;
  const px = pixel % width, py = (pixel - px) / width;
  const x0 = Math.max(0, px - radius), x1 = Math.min(width - 1, px + radius);
  const y1 = Math.min(height - 1, py + radius);
  for (let y = Math.max(0, py - radius); y <= y1; y++) {
    for (let at = y * width + x0; at <= y * width + x1; at++) {
      if (mature || pixels[at] === 0) pixels[at] = mature ? colours.mature : colours.tentative;
    }
  }
  soil(ink, pixel);
};

const removeInk = (ink, pixel, mature) => {
  const { counts, colours, pixels } = ink;
  const mine = mature ? counts.mature : counts.tentative;
  if (--mine[pixel] > 0) return;
  nearPixel(ink, pixel, (at) => {
    pixels[at] = nearPixel(ink, at, (near) => counts.mature[near] > 0) ? colours.mature
      : nearPixel(ink, at, (near) => counts.tentative[near] > 0) ? colours.tentative : 0;
    return false;
  });
  soil(ink, pixel);
};

const changeInk = (ink, view, landmarks, before, after) => {
  const from = before < 0 ? -1 : pixelOf(ink, view, landmarks, before), to = after < 0 ? -1 : pixelOf(ink, view, landmarks, after);
  const was = before >= 0 && landmarks.mature[before] === 1, is = after >= 0 && landmarks.mature[after] === 1;
  if (from === to && was === is) return;
  if (to >= 0) addInk(ink, to, is);
  if (from >= 0) removeInk(ink, from, was);
};

const fillInk = (ink, view, { landmarks, place }) => {
  for (let i = 0; i < place.length; i++) changeInk(ink, view, landmarks, -1, place[i]);
};

// What changed is taken over to the canvas.
const putInk = (ink) => {
  const [x0, y0, x1, y1] = ink.dirty;
  if (x1 > x0) ink.canvas.getContext("2d").putImageData(ink.image, 0, 0, x0, y0, x1 - x0, y1 - y0);
  ink.dirty.set([ink.width, ink.height, 0, 0]);
};

// Brings landmarks and their picture to scan k.
const drawFarLandmarks = (scene, radius) => {
  const { ink, present, camera, canvas, context, palette, k } = scene;
  const ratio = canvas.width / camera.width;
  const [x0, , , y1] = viewOf(camera);
  const view = { x: x0, y: y1, scale: camera.scale * ratio };
  const look = [view.x, view.y, view.scale, canvas.width, canvas.height, palette.paper].join();
  if (ink.look !== look || k < present.k) {
    showPresent(present, k);
    clearInk(ink, scene, Math.round(radius * ratio - .5));
    fillInk(ink, view, present);
    ink.look = look;
  } else {
    goOnTo(present, k, (before, after) => changeInk(ink, view, present.landmarks, before, after));
  }
  putInk(ink);
  context.drawImage(ink.canvas, 0, 0, camera.width, camera.height);
};
