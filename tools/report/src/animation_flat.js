// Moving bodies without WebGL: their edges on a 2-D canvas.

import { luminance } from './colours.js';
import { placed } from './motion.js';

const circle = (at) => Array.from({ length: 41 }, (_, i) => at((i * Math.PI) / 20));

/** A shape's edges in its own frame, as lists of points. */
function edges(shape) {
  switch (shape.shape) {
    case 'box': {
      const [a, b, c] = shape.size.map((v) => v / 2);
      const ring = (z) => [[-a, -b, z], [a, -b, z], [a, b, z], [-a, b, z], [-a, -b, z]];
      return [ring(-c), ring(c), ...ring(c).slice(0, 4).map(([x, y, z]) => [[x, y, -z], [x, y, z]])];
    }
    case 'cylinder': {
      const { radius, length } = shape;
      const rim = (z) => circle((t) => [radius * Math.cos(t), radius * Math.sin(t), z]);
      return [rim(-length / 2), rim(length / 2),
        [[0, 0, -length / 2], [radius, 0, -length / 2], [radius, 0, length / 2], [0, 0, length / 2]]];
    }
    case 'sphere': case 'ellipsoid': {
      const [a, b, c] = shape.radii ?? Array(3).fill(shape.radius);
      return [circle((t) => [a * Math.cos(t), b * Math.sin(t), 0]), circle((t) => [a * Math.cos(t), 0, c * Math.sin(t)]),
        circle((t) => [0, b * Math.cos(t), c * Math.sin(t)])];
    }
    case 'line': return [shape.points];
    default: return [[[0, 0, 0], shape.to]];
  }
}

/** A line needs more contrast with the paper than a surface. */
const visible = (colour) => (luminance([1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16))) > 0.5 ? '#8796a6' : colour);

export function makeFlat(motion, grid) {
  const wires = motion.bodies.map(({ shapes }) => shapes.map((shape) => ({ colour: visible(shape.colour),
    curves: edges(shape).map((curve) => curve.map((point) => placed(shape.pose, point))) })));

  return (context, project, poses, place, trails, scale) => {
    Object.assign(context, { lineJoin: 'round', lineCap: 'round' });
    const stroke = (points, colour, width, alpha = 1) => {
      Object.assign(context, { strokeStyle: colour, lineWidth: width * scale, globalAlpha: alpha });
      context.beginPath();
      let down = false;
      for (const point of points) {
        const [x, y] = point ? project(point) : [];
        if (point && down) context.lineTo(x, y);
        else if (point) context.moveTo(x, y);
        down = Boolean(point);
      }
      context.stroke();
      context.globalAlpha = 1;
    };
    grid?.lines.forEach((line) => stroke(line, '#d3d9e0', 0.8));
    motion.bodies.forEach(({ way, point }, b) => {
      if (!way) return;
      stroke(way, trails[b], 1.2, 0.35);
      stroke([...way.slice(0, place.i + 1), poses[b] ? placed(poses[b], point) : null], trails[b], 2);
    });
    wires.forEach((shapes, b) => {
      if (!poses[b]) return;
      for (const { colour, curves } of shapes) curves.forEach((curve) => stroke(curve.map((p) => placed(poses[b], p)), colour, 1.8));
    });
  };
}
