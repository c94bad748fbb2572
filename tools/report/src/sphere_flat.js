// The sphere without WebGL: an orthographic drawing on a 2-D canvas.

import { graticule, RADIUS } from './camera.js';

const GRID = graticule();

export function drawFlat(context, curves, camera, width, height, scale) {
  const project = camera.projector(width, height);
  const radius = RADIUS * Math.min(width, height);
  const [cx, cy] = [width / 2, height / 2];
  const shade = context.createRadialGradient(cx - radius * 0.3, cy - radius * 0.4, 0, cx, cy, radius * 1.1);
  shade.addColorStop(0, '#fbfcfd');
  shade.addColorStop(1, '#d9dfe6');
  context.fillStyle = shade;
  context.beginPath();
  context.arc(cx, cy, radius, 0, 2 * Math.PI);
  context.fill();
  Object.assign(context, { lineJoin: 'round', lineCap: 'round' });
  const stroke = (points, front, colour, lineWidth, alpha) => {
    Object.assign(context, { strokeStyle: colour, lineWidth: lineWidth * scale, globalAlpha: alpha });
    context.stroke(side(points, front, project));
    context.globalAlpha = 1;
  };
  const shown = curves.filter((curve) => curve.show);
  GRID.forEach((line) => stroke(line, true, '#c3cad2', 0.8, 1));
  shown.forEach(({ points, style }) => stroke(points, false, style.colour, 1.4, 0.25));
  shown.forEach(({ points, style }) => stroke(points, true, style.colour, 2, 1));
}

/** The part of a curve on the near or the far side, as a path; null points are gaps. */
function side(points, front, project) {
  const path = new Path2D();
  let down = false;
  for (const point of points) {
    const place = point ? project(point) : null;
    if (!place || (place[2] >= 0) !== front) {
      if (place && down) path.lineTo(place[0], place[1]);
      down = false;
      continue;
    }
    if (down) path.lineTo(place[0], place[1]); else path.moveTo(place[0], place[1]);
    down = true;
  }
  return path;
}
