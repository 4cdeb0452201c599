// What of the map a canvas shows: a middle in metres and a scale in pixels a metre; y points up on the map, down on screen.
const makeCamera = () => ({ x: 0, y: 0, scale: 1, width: 1, height: 1 });

const toScreenX = (camera, x) => (x - camera.x) * camera.scale + camera.width / 2;
const toScreenY = (camera, y) => camera.height / 2 - (y - camera.y) * camera.scale;

const fitCamera = (camera, [x0, x1, y0, y1]) => {
  camera.x = (x0 + x1) / 2;
  camera.y = (y0 + y1) / 2;
  camera.scale = Math.min(camera.width / (x1 - x0), camera.height / (y1 - y0));
};

// Zooms about a point of the screen, which stays where it is.
const zoomCamera = (camera, factor, px, py) => {
  const dx = (px - camera.width / 2) / camera.scale, dy = (camera.height / 2 - py) / camera.scale;
  const before = camera.scale;
  camera.scale = Math.min(400, Math.max(1e-4, camera.scale * factor));
  camera.x += dx * (1 - before / camera.scale);
  camera.y += dy * (1 - before / camera.scale);
};

const panCamera = (camera, px, py) => {
  camera.x -= px / camera.scale;
  camera.y += py / camera.scale;
};

// [x0, x1, y0, y1] on the map, with a margin in pixels.
const viewOf = (camera, margin = 0) => {
  const dx = (camera.width / 2 + margin) / camera.scale, dy = (camera.height / 2 + margin) / camera.scale;
  return [camera.x - dx, camera.x + dx, camera.y - dy, camera.y + dy];
};
