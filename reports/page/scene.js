// One picture of the drive: what the navigator knew after scan k. The scene is the player: its camera, colours, time and drive.
const drawScene = (scene) => {
  scene.context.globalAlpha = 1;
  for (const draw_ of [drawGround, drawLandmarks_, drawWays, drawMerges, drawScan, drawCloud, drawVehicle, drawClosings,
    drawScaleBar]) {
    draw_(scene);
  }
  scene.context.setLineDash([]);
};
