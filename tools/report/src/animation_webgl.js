// Moving bodies by three.js: lit shapes, their shadows straight down on the floor, the ways of points.

import { AmbientLight, BoxGeometry, Color, ConeGeometry, CylinderGeometry, DirectionalLight, DoubleSide, EdgesGeometry, Group,
  Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, Scene, SphereGeometry } from 'three';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { luminance } from './colours.js';
import { placed, turnFromZ } from './motion.js';
import { Eye, lines, render, segments } from './webgl.js';

const SHADOW = 0xcdd4dc;
const MARK = 0.7;  // radians

const lit = (colour) => new MeshLambertMaterial({ color: colour });

/** Light on dark and dark on light: the mark by which one sees a round body turn. */
function markOf(colour) {
  const rgb = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  return luminance(rgb) > 0.4 ? '#2f3a46' : '#f6f8fa';
}

function stand(object, { at, turn: [w, x, y, z] }) {
  object.position.set(...at);
  object.quaternion.set(x, y, z, w);
  return object;
}

/** Along z, where three.js puts it along y. */
const upright = (geometry) => geometry.rotateX(Math.PI / 2);

function solids(shape) {
  const { colour } = shape;
  switch (shape.shape) {
    case 'box': {
      const box = new BoxGeometry(...shape.size);
      const rim = new LineSegmentsGeometry().fromEdgesGeometry(new EdgesGeometry(box));
      return [new Mesh(box, lit(colour)), lines(rim, new Color(colour).multiplyScalar(0.45), 1.3)];
    }
    case 'cylinder': {
      const { radius: r, length } = shape;
      const sector = upright(new CylinderGeometry(r * 1.004, r * 1.004, length * 1.004 + r * 0.002, 12, 1, false, 0, MARK));
      return [new Mesh(upright(new CylinderGeometry(r, r, length, 72)), lit(colour)),
        new Mesh(sector, new MeshLambertMaterial({ color: markOf(colour), side: DoubleSide }))];
    }
    case 'sphere': case 'ellipsoid': {
      const ball = (radius, ...part) => upright(new SphereGeometry(radius, 64, 40, ...part));
      const mark = lit(markOf(colour));
      const parts = [new Mesh(ball(1), lit(colour)), new Mesh(ball(1.004, 0, MARK), mark), new Mesh(ball(1.004, Math.PI, MARK), mark),
        new Mesh(ball(1.006, 0, 2 * Math.PI, 0, 0.3), mark)];
      parts.forEach((part) => part.scale.set(...(shape.radii ?? Array(3).fill(shape.radius))));
      return parts;
    }
    case 'line': {
      const geometry = segments(shape.points);
      return geometry ? [lines(geometry, colour, 2.6)] : [];
    }
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

/** The way of a point: all of it thin, what is behind the body strong. */
function makeTrail({ way, point }, colour) {
  const whole = segments(way);
  if (!whole) return null;
  const before = [];  // how many segments lie before each node
  way.forEach((p, i) => before.push(i === 0 ? 0 : before[i - 1] + (way[i - 1] && p ? 1 : 0)));
  const past = segments(way);
  const last = new LineSegmentsGeometry().setPositions([0, 0, 0, 0, 0, 0]);
  const ends = last.attributes.instanceStart.data;
  const [thin, strong, tip] = [lines(whole, new Color(colour).lerp(new Color(0xffffff), 0.45), 1.4), lines(past, colour, 2.2), lines(last, colour, 2.2)];
  thin.material.depthWrite = false;  // the strong line lies on it
  [thin, strong, tip].forEach((line, i) => { line.renderOrder = 1 + i; });
  return { parts: [thin, strong, tip], show(pose, { i }) {
    past.instanceCount = before[i];
    strong.visible = before[i] > 0;
    tip.visible = Boolean(pose && way[i]);
    if (!tip.visible) return;
    ends.array.set([...way[i], ...placed(pose, point)]);
    ends.needsUpdate = true;
  } };
}

export function makeStage(motion, grid, trails, reach) {
  const scene = new Scene();
  const eye = new Eye(reach);
  const light = new DirectionalLight(0xffffff, 1.9);
  light.position.set(-0.5, 0.8, 1);
  eye.add(light, light.target);
  scene.add(eye, new AmbientLight(0xffffff, 1.7));
  if (grid) scene.add(Object.assign(lines(new LineSegmentsGeometry().setPositions(grid.lines.flat(2)), 0xd3d9e0, 0.9), { renderOrder: -1 }));
  const ways = motion.bodies.map((body, b) => (body.way ? makeTrail(body, trails[b]) : null));
  ways.forEach((trail) => trail && scene.add(...trail.parts));
  const bodies = motion.bodies.map(({ shapes }) => {
    const group = new Group();
    for (const shape of shapes) {
      const parts = solids(shape);
      if (parts.length) group.add(stand(new Group(), shape.pose).add(...parts));
    }
    scene.add(group);
    return group;
  });
  const flatten = new Matrix4().makeScale(1, 1, 0);
  const shadows = [];
  if (grid) {
    const dark = new MeshBasicMaterial({ color: SHADOW, side: DoubleSide, depthWrite: false });
    bodies.forEach((body, b) => body.traverse((part) => {
      if (!part.isMesh || part.userData.width) return;  // lines cast none
      const shadow = Object.assign(new Mesh(part.geometry, dark), { matrixAutoUpdate: false, renderOrder: -2, frustumCulled: false });
      shadows.push({ shadow, part, b });
    }));
    scene.add(...shadows.map(({ shadow }) => shadow));
  }

  /** -> the picture, as a promise of ImageData. */
  return (view, poses, place, width, height, scale) => {
    eye.stand(view.frame, view.target, view.unit, width, height);
    bodies.forEach((body, b) => {
      body.visible = Boolean(poses[b]);
      if (poses[b]) stand(body, poses[b]).updateMatrixWorld(true);
      ways[b]?.show(poses[b], place);
    });
    for (const { shadow, part, b } of shadows) {
      shadow.visible = bodies[b].visible;
      shadow.matrix.multiplyMatrices(flatten, part.matrixWorld);
    }
    return render(scene, eye, width, height, scale);
  };
}
