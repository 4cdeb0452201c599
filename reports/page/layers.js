// Layers keep what is drawn the same again and again: a long drive is not stroked anew for every frame. A layer is one canvas for one
// look (camera, colours, what is shown).
const makeLayer = () => ({ canvas: element("canvas"), look: "", k: -1 });

const lookOf = ({ camera, canvas, palette, show }) =>
  [camera.x, camera.y, camera.scale, canvas.width, canvas.height, palette.paper, show.truth, show.final].join();

// The layer's context, as the scene's; cleared when the look is another one.
const onLayer = (scene, layer) => {
  const look = lookOf(scene);
  const context = layer.canvas.getContext("2d");
  if (layer.look !== look || scene.k < layer.k) {
    layer.canvas.width = scene.canvas.width;
    layer.canvas.height = scene.canvas.height;
    const ratio = scene.canvas.width / scene.camera.width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    layer.look = look;
    layer.k = -1;
  }
  return { ...scene, context };
};

const putLayer = ({ context, camera }, layer) => context.drawImage(layer.canvas, 0, 0, camera.width, camera.height);

// What does not change while time goes on.
const drawGround = (scene) => {
  for (const draw_ of [drawGrid, drawTrueLandmarks, drawFinal, drawComing]) draw_(scene);
};

// The ways of truth and vehicle between two scans.
const drawTrail = (scene, from) => {
  for (const draw_ of [drawTruePath, drawPath]) draw_(scene, from);
};

// A camera that follows changes with every frame: there nothing can be kept.
const drawWays = (scene) => {
  if (scene.follow) {
    drawGround(scene);
    drawTrail(scene, 0);
    return;
  }
  const { ground, trail } = scene.layers;
  const below = onLayer(scene, ground);
  if (ground.k < 0) drawGround(below);
  ground.k = 0;
  const above = onLayer(scene, trail);
  if (trail.k < scene.k) drawTrail(above, Math.max(0, trail.k));
  trail.k = scene.k;
  putLayer(scene, ground);
  putLayer(scene, trail);
};
