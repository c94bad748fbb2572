// Shapes and lines as three.js draws them: finely for WebGL, of fewer faces and with lines of its own for SVG.

import { AmbientLight, BoxGeometry, CircleGeometry, Color, ConeGeometry, CylinderGeometry, DirectionalLight, EdgesGeometry, Float32BufferAttribute, Group,
  LineBasicMaterial, LineSegments, BufferGeometry, Mesh, MeshLambertMaterial, RingGeometry, SphereGeometry, TorusGeometry } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { luminance } from '../charts/colours.js';
import { turnFromZ } from './motion.js';

const MARK = 0.7;   // radians
const STRIP = 0.2;  // the same, along a cylinder
const RIM = 0.82;   // of the radius: so far a mark reaches
const METAL = '#a3adb8';
const TYRE = 0.11;  // of the radius, half its thickness
const SPOKES = 9;
const TUBE = 0.016; // of the largest extent of a line, its radius
const BENDS = 8;    // points of a line that is drawn as tubes; longer ones are curves
const SHEER = 0.3;  // opacity of what has something inside

/** A colour of the style sheet, as it is now. */
export const styled = (name) => new Color(getComputedStyle(document.documentElement).getPropertyValue(name).trim());

/** Pairs of points that follow each other; null points are gaps. */
export function pairs(points) {
  const out = [];
  for (let i = 1; i < points.length; ++i) if (points[i - 1] && points[i]) out.push(...points[i - 1], ...points[i]);
  return out;
}

/** Segments, six numbers each, of a width in pixels; its `place(positions)` takes others. */
export function lines(solid, positions, color, width, { opacity = 1, renderOrder = 0, depthTest = true, depthWrite = true } = {}) {
  const more = { color, linewidth: width, opacity, transparent: opacity < 1, depthTest, depthWrite };
  const object = solid ? new LineSegments2(new LineSegmentsGeometry(), new LineMaterial(more))
    : new LineSegments(new BufferGeometry(), new LineBasicMaterial({ ...more, linecap: 'round' }));
  object.place = (numbers) => {
    object.visible = numbers.length > 0;
    if (!object.visible) return;
    if (solid) {  // (a geometry never draws more segments than it had at first)
      object.geometry.dispose();
      object.geometry = new LineSegmentsGeometry().setPositions(numbers);
    } else {
      object.geometry.setAttribute('position', new Float32BufferAttribute(numbers, 3));
    }
  };
  object.place(positions);
  return Object.assign(object, { renderOrder, frustumCulled: false });
}

/** A lamp beside the eye, and light from all sides. (WebGL divides by π as a physical surface does, SVG does not.) */
export function addLight(scene, solid) {
  const part = solid ? 1 : 1 / Math.PI;
  const light = new DirectionalLight(0xffffff, 1.9 * part);
  scene.add(light, light.target, new AmbientLight(0xffffff, 1.7 * part));
  return (camera) => {
    light.position.set(-0.5, 0.8, 1).applyQuaternion(camera.quaternion);
  };
}

/** Amber on dark and dark on light: the mark by which one sees a round body turn. (White looks like a hole.) */
const markOf = (colour) => (luminance([1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16))) > 0.4 ? '#2f3a46' : '#e9b949');

export function stand(object, { at, turn: [w, x, y, z] }) {
  object.position.set(...at);
  object.quaternion.set(x, y, z, w);
  return object;
}

const upright = (geometry) => geometry.rotateX(Math.PI / 2);  // along z, where three.js puts it along y
/** shell: one sees through it. */
const lit = (color, shell) => new MeshLambertMaterial(shell ? { color, transparent: true, opacity: SHEER, depthWrite: false } : { color });

/** A cylinder with a wedge of another colour inside the rim of both ends, and along it where it is long. No face lies on
 * another: SVG sorts whole faces. */
function cylinder({ radius: r, length, colour, shell }, round) {
  const [body, mark, rest] = [lit(colour, shell), lit(markOf(colour), shell), 2 * Math.PI - MARK];
  const [sides, few] = [round, Math.max(3, Math.round((round * MARK) / (2 * Math.PI)))];
  const mantle = (material, count, from, angle) => new Mesh(upright(new CylinderGeometry(r, r, length, count, 1, true, from, angle)), material);
  const wall = length > r ? [mantle(body, sides, (Math.PI + STRIP) / 2, 2 * Math.PI - STRIP), mantle(mark, few, (Math.PI - STRIP) / 2, STRIP)]
    : [mantle(body, sides, 0, 2 * Math.PI)];
  const ends = [0, Math.PI].flatMap((turn) => {  // about x: the wedge is on both sides of it
    const at = (geometry, material) => new Mesh(geometry.translate(0, 0, length / 2).rotateX(turn), material);
    return [at(new RingGeometry(RIM * r, r, sides, 1), body), at(new CircleGeometry(RIM * r, sides, MARK / 2, rest), body),
      at(new CircleGeometry(RIM * r, few, -MARK / 2, MARK), mark)];
  });
  return [...wall, ...ends];
}

/** A rod between two points. */
function rod(from, to, radius, sides, material) {
  const along = to.map((v, i) => v - from[i]);
  const length = Math.hypot(...along);
  if (!(length > 0)) return [];
  const geometry = upright(new CylinderGeometry(radius, radius, length, sides)).translate(0, 0, length / 2);
  return [stand(new Mesh(geometry, material), { at: from, turn: turnFromZ(along) })];
}

/** A tyre on a rim, a hub and spokes, one of them marked, by which one sees it turn. */
function wheel({ radius: r, length, colour }, solid) {
  const [thick, metal, sides] = [TYRE * r, lit(METAL), solid ? 10 : 5];
  const ring = (far, part, ...count) => new Mesh(new TorusGeometry(far, part, ...count), metal);
  const tyre = Object.assign(ring(r - thick, thick, ...(solid ? [16, 72] : [6, 30])), { material: lit(colour) });
  tyre.scale.z = length / 2 / thick;
  const rim = r - 2 * thick;
  const spokes = Array.from({ length: SPOKES }, (_, i) => {
    const angle = (2 * Math.PI * i) / SPOKES;
    const thin = (i ? 0.014 : 0.04) * r;
    return rod([0, 0, 0], [rim * Math.cos(angle), rim * Math.sin(angle), 0], thin, sides, i ? metal : lit(markOf(colour)));
  });
  return [tyre, ring(rim, 0.035 * r, ...(solid ? [10, 72] : [4, 30])), ...spokes.flat(), ...rod([0, 0, -0.7 * length], [0, 0, 0.7 * length], 0.09 * r, 2 * sides, metal)];
}

/** Tubes along a line, with round joints. */
function tubes(points, colour, solid) {
  const extent = Math.max(...[0, 1, 2].map((k) => Math.max(...points.map((p) => p[k])) - Math.min(...points.map((p) => p[k]))));
  const [radius, material, sides] = [TUBE * extent, lit(colour), solid ? 20 : 6];
  const joints = points.map((point) => new Mesh(new SphereGeometry(radius, sides, sides / 2), material).translateX(point[0]).translateY(point[1]).translateZ(point[2]));
  return [...points.slice(1).flatMap((point, i) => rod(points[i], point, radius, sides, material)), ...joints];
}

/** The parts of a shape, in its own frame. */
export function solids(shape, solid) {
  const { colour } = shape;
  const round = solid ? 72 : 36;  // sides of a circle
  switch (shape.shape) {
    case 'box': {
      const box = new BoxGeometry(...shape.size);
      return [new Mesh(box, lit(colour)), lines(solid, [...new EdgesGeometry(box).attributes.position.array], new Color(colour).multiplyScalar(0.45), 1.3)];
    }
    case 'cylinder': return cylinder(shape, round);
    case 'sphere': case 'ellipsoid': {
      const ball = (radius, ...part) => upright(new SphereGeometry(radius, ...part));
      const mark = lit(markOf(colour), shape.shell);
      const [few, over] = solid ? [6, 1.004] : [4, 1.03];  // (SVG sorts whole faces)
      const parts = [new Mesh(ball(1, round, round / 2), lit(colour, shape.shell)), new Mesh(ball(over, few, round / 2, 0, MARK), mark),
        new Mesh(ball(over, few, round / 2, Math.PI, MARK), mark), new Mesh(ball(over + 0.002, round, 3, 0, 2 * Math.PI, 0, 0.3), mark)];
      parts.forEach((part) => part.scale.set(...(shape.radii ?? Array(3).fill(shape.radius))));
      return parts;
    }
    case 'wheel': return wheel(shape, solid);
    case 'line': return shape.points.length <= BENDS ? tubes(shape.points, colour, solid) : [lines(solid, pairs(shape.points), colour, 2.6)];
    default: {
      const length = Math.hypot(...shape.to);
      if (!(length > 0)) return [];
      const [head, thick] = [length * 0.2, length * 0.02];
      const group = new Group();
      group.add(new Mesh(upright(new CylinderGeometry(thick, thick, length - head, 16)).translate(0, 0, (length - head) / 2), lit(colour)),
        new Mesh(upright(new ConeGeometry(thick * 3, head, 24)).translate(0, 0, length - head / 2), lit(colour)));
      return [stand(group, { at: [0, 0, 0], turn: turnFromZ(shape.to) })];
    }
  }
}
