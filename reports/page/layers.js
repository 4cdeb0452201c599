// Ground and ways are kept on canvases of their own as long as the camera stands still: a long drive is not stroked anew for every
// frame. The ways are added in pieces of so many scans, and what came after the last piece is drawn over them: so a picture depends
// on its scan, not on what was shown before. A camera that follows changes with every frame: there nothing can be kept.
const scans_of_piece = 512;

const makeLayer = () => ({ canvas: element("canvas"), look: "", k: 0 });

const lookOf = ({ camera, canvas, palette, show }) =>
  [camera.x, camera.y, camera.scale, canvas.width, canvas.height, palette.paper, show.truth, show.final].join();

// What does not change while time goes on.
const drawGroundAnew = (scene) => {
  const { context, camera, palette } = scene;
  context.fillStyle = palette.paper;
  context.fillRect(0, 0, camera.width, camera.height);
  for (const draw_ of [drawGrid, drawTrueLandmarks, drawFinal, drawComing]) draw_(scene);
};

// The ways of truth and vehicle between two scans.
const drawWaysBetween = (scene, from, to) => {
  drawTruePath(scene, from, to);
  drawPath(scene, from, to);
};

// An empty layer, unless it shows what it has to.
const renew = (layer, scene, look) => {
  if (layer.look === look && scene.k >= layer.k) return false;
  const { canvas, camera } = scene;
  layer.canvas.width = canvas.width;
  layer.canvas.height = canvas.height;
  layer.context = layer.canvas.getContext("2d");
  const ratio = canvas.width / camera.width;
  layer.context.setTransform(ratio, 0, 0, ratio, 0, 0);
  layer.look = look;
  layer.k = 0;
  return true;
};

const putLayer = ({ context, camera }, layer) => context.drawImage(layer.canvas, 0, 0, camera.width, camera.height);

const drawGround = (scene) => {
  if (scene.follow) {
    drawGroundAnew(scene);
    return;
  }
  if (renew(scene.ground, scene, lookOf(scene))) drawGroundAnew({ ...scene, context: scene.ground.context });
  putLayer(scene, scene.ground);
};

const drawWays = (scene) => {
  const { trail, k } = scene;
  if (scene.follow) {
    drawWaysBetween(scene, 0, k);
    return;
  }
  renew(trail, scene, lookOf(scene));
  for (; trail.k + scans_of_piece <= k; trail.k += scans_of_piece) {
    drawWaysBetween({ ...scene, context: trail.context }, trail.k, trail.k + scans_of_piece);
  }
  putLayer(scene, trail);
  drawWaysBetween(scene, trail.k, k);
};
