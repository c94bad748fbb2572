// The figure `sphere`: curves on the unit sphere, turned by dragging or with the arrow keys.

import { CircleGeometry, Mesh, MeshBasicMaterial, Scene } from 'three';
import { h } from '../dom.js';
import { figure, remark } from '../figure.js';
import { makeLegend } from '../charts/legend.js';
import { styleOf } from '../charts/palette.js';
import { columnsToCsv } from '../save.js';
import { lines, pairs, styled } from './shapes.js';
import { HOME, Stage } from './stage.js';

const HEIGHT = 340;
const ROOM = 0.8;      // half the edge of the box that is in sight
const START = 0.035;   // radius of the disk where a curve starts
const FAINT = 0.25;    // opacity of what is on the far side

export function sphere(block) {
  if (!Array.isArray(block.series)) throw new Error('no list "series"');
  const curves = block.series.map(readCurve);
  const holder = h('div', { class: 'stage3d drawing', role: 'img', tabindex: 0, 'aria-label':
    `Curves on the unit sphere: ${block.title ?? 'untitled'}; series: ${curves.map((c) => c.name).join(', ')}. Arrow keys turn the sphere.` });
  const stage = new Stage(holder, { height: () => HEIGHT, from: HOME, floor: false, build: (solid) => build(curves, solid),
    box: [[-ROOM, -ROOM, -ROOM], [ROOM, ROOM, ROOM]] });
  const legend = makeLegend(curves, (i, visible) => {
    curves[i].show = visible;
    stage.rebuild();
  });
  const far = Math.max(0, ...curves.map((curve) => curve.defect));
  const csv = () => columnsToCsv(curves.flatMap(({ name, points }) => ['x', 'y', 'z'].map((axis, k) => ({ name: `${name} ${axis}`, values: points.map((p) => p?.[k]) }))));
  const names = () => curves.filter((curve) => curve.show).map(({ name, style }) => ({ name, colour: style.colour }));
  const element = figure(block, [holder, legend.element, far > 1e-3 ? remark(`Some points lie off the unit sphere, by up to ${far.toPrecision(2)}.`) : null,
    block.note ? remark(block.note) : null], { svg: () => stage.picture(false, names()), png: () => stage.picture(true, names()), csv });
  return { element, draw: () => stage.draw(), picture: () => stage.picture(false, names()), dispose: () => stage.dispose() };
}

function readCurve(series, i) {
  if (!Array.isArray(series?.points)) throw new Error(`series ${i + 1} (${series?.name}) needs the list points`);
  const points = series.points.map((p) => (Array.isArray(p) && p.length === 3 && p.every(Number.isFinite) ? p : null));  // null: a gap
  return { name: String(series.name ?? ''), style: styleOf(series), show: true, points,
    defect: Math.max(0, ...points.map((p) => (p ? Math.abs(Math.hypot(...p) - 1) : 0))) };
}

/** Meridians and parallels every 30 degrees. */
function graticule() {
  const circle = (at) => pairs(Array.from({ length: 73 }, (_, i) => at((i * Math.PI) / 36)));
  const steps = Array.from({ length: 6 }, (_, k) => (k * Math.PI) / 6);
  return [...steps.map((a) => circle((t) => [Math.cos(t) * Math.cos(a), Math.cos(t) * Math.sin(a), Math.sin(t)])),
    ...steps.slice(1).map((b) => circle((t) => [Math.sin(b) * Math.cos(t), Math.sin(b) * Math.sin(t), Math.cos(b)]))].flat();
}

/** A disk through the centre, always towards the eye, hides the far side; over it the curves are drawn once more, faintly. */
function build(curves, solid) {
  const scene = new Scene();
  const disk = (radius, color) => new Mesh(new CircleGeometry(radius, 64), new MeshBasicMaterial({ color }));
  const facing = [disk(0.994, styled('--ball'))];
  scene.add(facing[0], lines(solid, graticule(), styled('--mesh'), 0.8));
  for (const { points, style } of curves.filter((curve) => curve.show)) {
    const colour = styled(style.colour.slice(4, -1));
    scene.add(lines(solid, pairs(points), colour, 2), lines(solid, pairs(points), colour, 1.4, { opacity: FAINT, renderOrder: 1, depthTest: false }));
    const first = points.find((p) => p);
    if (!first) continue;
    const dot = disk(START, colour);
    dot.position.set(...first).multiplyScalar(1.01);
    facing.push(dot);
    scene.add(dot);
  }
  return { scene, update: (camera) => facing.forEach((mesh) => mesh.quaternion.copy(camera.quaternion)), labels: [] };
}
