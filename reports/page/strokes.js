// Shapes on a canvas.
const sigmas_of_95 = 2.4477;  // {e : eᵀP⁻¹e = 5.99} in the plane

const circle = (context, x, y, radius) => {
  context.moveTo(x + radius, y);
  context.arc(x, y, radius, 0, 2 * Math.PI);
};

const strokeAs = (context, colour, width, dash = []) => {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.setLineDash(dash);
};

const stroke = (context, colour, width, trace, dash) => {
  strokeAs(context, colour, width, dash);
  context.beginPath();
  trace();
  context.stroke();
};

const traceEllipse = (context, camera, x, y, ellipse, i) => {
  const scale = sigmas_of_95 * camera.scale;
  const a = ellipse.a[i] * scale, b = ellipse.b[i] * scale, angle = -ellipse.angle[i];
  const px = toScreenX(camera, x), py = toScreenY(camera, y);
  context.moveTo(px + a * Math.cos(angle), py + a * Math.sin(angle));
  context.ellipse(px, py, a, b, angle, 0, 2 * Math.PI);
};

const cross = (context, x, y, half) => {
  context.moveTo(x - half, y - half);
  context.lineTo(x + half, y + half);
  context.moveTo(x - half, y + half);
  context.lineTo(x + half, y - half);
};

const drawArrowhead = (context, x, y, heading, size) => {
  const corner = (along, aside) => [
    x + size * (along * Math.cos(heading) - aside * Math.sin(heading)),
    y - size * (along * Math.sin(heading) + aside * Math.cos(heading))];
  context.beginPath();
  context.moveTo(...corner(1, 0));
  for (const [along, aside] of [[-.7, .6], [-.35, 0], [-.7, -.6]]) context.lineTo(...corner(along, aside));
  context.closePath();
};
