// The figure `sphere`: curves on the unit sphere, turned by dragging or with the arrow keys.

import { Camera } from './camera.js';
import { h, inline } from './dom.js';
import { figure } from './figure.js';
import { makeLegend } from './legend.js';
import { styleOf } from './palette.js';
import { FONT } from './chart.js';
import { followWidth } from './plot.js';
import { drawFlat } from './sphere_flat.js';
import { makeScene } from './sphere_webgl.js';
import { afterFirstPicture, webglWorks } from './webgl.js';

const HEIGHT = 340;
const SHARPEST = 2;  // device pixels per CSS pixel at least, so that print is sharp too

export function sphere(block) {
  if (!Array.isArray(block.series)) throw new Error('no list "series"');
  const curves = block.series.map(readCurve);
  const camera = new Camera();
  const canvas = h('canvas', { class: 'globe', role: 'img', tabindex: 0, 'aria-label':
    `Curves on the unit sphere: ${block.title ?? 'untitled'}; series: ${curves.map((c) => c.name).join(', ')}. ` +
    'Arrow keys turn the sphere.' });
  let scene = null;
  let [painting, again] = [false, false];

  const paint = async () => {
    const scale = Math.max(SHARPEST, devicePixelRatio);
    const [width, height] = [Math.round(canvas.clientWidth * scale), Math.round(HEIGHT * scale)];
    if (width === 0) return;
    const seen = camera.copy();
    const picture = scene ? await scene.draw(seen, width, height, scale) : null;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const context = canvas.getContext('2d');
    context.fillStyle = '#fff';
    context.fillRect(0, 0, width, height);
    if (picture) context.putImageData(picture, 0, 0);
    else drawFlat(context, curves, seen, width, height, scale);
    drawOverlay(context, curves, seen, width, height, scale);
  };
  /** Paints in the next frame, one picture at a time. */
  const repaint = () => {
    again = true;
    if (painting) return;
    painting = true;
    requestAnimationFrame(async () => {
      again = false;
      await paint();
      painting = false;
      if (again) repaint();
    });
  };

  const legend = makeLegend(curves, { live: false, onToggle: (i, visible) => {
    curves[i].show = visible;
    repaint();
  } });
  const notes = [];
  const far = Math.max(0, ...curves.map((curve) => curve.defect));
  if (far > 1e-3) notes.push(`Some points lie off the unit sphere, by up to ${far.toPrecision(2)}.`);
  const element = figure(block, [canvas, legend.element, notes.map((text) => h('p', { class: 'remark' }, text)),
    block.note ? h('p', { class: 'remark' }, inline(block.note)) : null]);
  /** The flat picture at once, the solid one when WebGL is there. */
  const draw = async () => {
    handle(canvas, camera, repaint);
    followWidth(canvas, repaint);
    paint();
    await afterFirstPicture();
    if (webglWorks()) scene = makeScene(curves);
    else element.append(h('p', { class: 'remark' }, 'Drawn flat: this browser offers no WebGL.'));
    repaint();
  };
  return { element, draw };
}

function readCurve(series, i) {
  if (!Array.isArray(series?.points)) throw new Error(`series ${i + 1} (${series?.name}) needs the list points`);
  let defect = 0;
  const points = series.points.map((point) => {
    const good = Array.isArray(point) && point.length === 3 && point.every(Number.isFinite);
    if (!good) return null;  // a gap
    defect = Math.max(defect, Math.abs(Math.hypot(...point) - 1));
    return point;
  });
  return { name: String(series.name ?? ''), style: styleOf(series), show: true, points, defect };
}

function handle(canvas, camera, repaint) {
  const perPixel = 0.009;
  canvas.addEventListener('pointerdown', (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener('pointermove', (event) => {
    if (!canvas.hasPointerCapture(event.pointerId)) return;
    camera.turn(-event.movementX * perPixel, event.movementY * perPixel);
    repaint();
  });
  canvas.addEventListener('dblclick', () => { camera.goHome(); repaint(); });
  canvas.addEventListener('keydown', (event) => {
    const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!turn) return;
    event.preventDefault();
    camera.turn(turn[0] * 0.12, turn[1] * 0.12);
    repaint();
  });
}

/** What both ways of drawing share: the space axes with their names, and a ring where each curve starts. */
function drawOverlay(context, curves, camera, width, height, scale) {
  const project = camera.projector(width, height);
  Object.assign(context, { font: `${12.5 * scale}px ${FONT}`, textAlign: 'center', textBaseline: 'middle' });
  context.setLineDash([]);
  [['x', [1, 0, 0]], ['y', [0, 1, 0]], ['z', [0, 0, 1]]].forEach(([name, axis]) => {
    const at = (r) => project(axis.map((c) => c * r));
    const [centre, tip] = [project([0, 0, 0]), at(1.16)];
    // The part of the axis that the sphere does not hide.
    const reach = Math.hypot(at(1)[0] - centre[0], at(1)[1] - centre[1]);
    const unit = Math.hypot(...[0, 1].map((i) => project(camera.frame().right)[i] - centre[i]));
    const hidden = tip[2] < 0;
    const from = hidden ? Math.min(1.16, unit / Math.max(reach, 1e-9)) : 1;
    context.strokeStyle = context.fillStyle = hidden ? '#9aa3ad' : '#4a525c';
    context.lineWidth = 1.2 * scale;
    context.beginPath();
    context.moveTo(...at(from).slice(0, 2));
    context.lineTo(tip[0], tip[1]);
    context.stroke();
    if (hidden && reach * 1.25 < unit) return;
    Object.assign(context, { strokeStyle: '#fffc', lineWidth: 3 * scale, lineJoin: 'round' });
    context.strokeText(name, ...at(1.25).slice(0, 2));
    context.fillText(name, ...at(1.25).slice(0, 2));
  });
  for (const { show, points, style } of curves) {
    const first = show ? points.find((point) => point) : null;
    if (!first) continue;
    const [x, y, depth] = project(first);
    context.globalAlpha = depth >= 0 ? 1 : 0.35;
    Object.assign(context, { fillStyle: '#fff', strokeStyle: style.colour, lineWidth: 2 * scale });
    context.beginPath();
    context.arc(x, y, 4 * scale, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
  }
  context.globalAlpha = 1;
}
