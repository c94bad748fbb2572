// The figure `animation`: bodies that move, with play, a bar to scrub, speed, and a view turned by dragging or keys.

import { makeFlat } from './animation_flat.js';
import { makeStage } from './animation_webgl.js';
import { ABOVE, Camera, HOME } from './camera.js';
import { FONT } from './chart.js';
import { h, inline } from './dom.js';
import { figure } from './figure.js';
import { formatNumber, formatShort } from './format.js';
import { floorGrid, placed, placeInTime, poseAt, readMotion } from './motion.js';
import { followWidth } from './plot.js';
import { View } from './view.js';
import { afterFirstPicture, webglWorks } from './webgl.js';

const heightFor = (width) => Math.round(Math.max(250, Math.min(380, 0.75 * width)));
const SHARPEST = 2;       // device pixels per CSS pixel at least while nothing moves, so that print is sharp too
const TICKS = 1000;       // of the bar
const SPEEDS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
const PLEASANT = [4, 25]; // seconds that a motion may take as it is; others are brought near 10
const TRAILS = ['#b4460a', '#0072b2', '#007a59', '#b0508c', '#2e2585', '#7a1f3d'];

export function animation(block) {
  const motion = readMotion(block);
  const { times, bodies } = motion;
  const trails = bodies.map((_, b) => TRAILS[b % TRAILS.length]);
  const [start, end] = [times[0], times[times.length - 1]];
  const view = new View(motion, new Camera(block.view === 'top' ? ABOVE : HOME), Boolean(block.floor));
  const grid = block.floor ? floorGrid(motion.box, view.follows ? 1.5 * motion.reach : 0) : null;
  let now = start;

  const canvas = h('canvas', { class: 'globe stage3d', role: 'img', tabindex: 0, 'aria-label':
    `Animation: ${block.title ?? 'untitled'}; ${bodies.map((body) => body.name).join(', ')}; t from ${formatShort(start)} to ` +
    `${formatShort(end)}. Space plays, arrow keys turn the view, plus and minus zoom, 0 resets.` });
  const bar = h('input', { type: 'range', class: 'bar', min: 0, max: TICKS, value: 0, 'aria-label': 'time',
    oninput: () => { pause(); seek(start + (bar.value / TICKS) * (end - start)); } });
  const clock = h('output', { class: 'clock' });
  const play = h('button', { type: 'button', class: 'play', onclick: () => (playing ? pause() : run()) });
  const speed = h('select', { 'aria-label': 'speed' }, SPEEDS.map((s) => h('option', { value: s }, `${s}×`)));
  speed.value = speedFor(end - start);
  const follow = h('button', { type: 'button', 'aria-pressed': 'false', onclick: () => look(() => { view.follows = !view.follows; }) }, 'follow');
  const tools = [
    h('button', { type: 'button', onclick: () => look(() => view.turnTo(ABOVE)) }, 'from above'), follow,
    h('button', { type: 'button', class: 'home', onclick: () => look(() => view.goHome()) }, 'reset view')];

  const flat = makeFlat(motion, grid);
  let [stage, drawing, again, playing] = [null, false, false, false];  // no stage: drawn flat
  const paint = async () => {
    const scale = playing ? devicePixelRatio : Math.max(SHARPEST, devicePixelRatio);
    if (canvas.clientWidth === 0) return;
    const tall = heightFor(canvas.clientWidth);
    canvas.style.height = `${tall}px`;
    const [width, height] = [Math.round(canvas.clientWidth * scale), Math.round(tall * scale)];
    const place = placeInTime(times, now);
    const poses = bodies.map((body) => poseAt(body, place));
    const seen = view.seen(poses[0], width, height);
    const picture = stage ? await stage(seen, poses, place, width, height, scale) : null;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const context = canvas.getContext('2d');
    context.fillStyle = '#fff';
    context.fillRect(0, 0, width, height);
    if (picture) context.putImageData(picture, 0, 0);
    else flat(context, seen.project, poses, place, trails, scale);
    drawOverlay(context, { motion, grid, poses, seen, height, scale });
  };
  /** Paints in the next frame, one picture at a time. */
  const repaint = () => {
    again = true;
    if (drawing) return;
    drawing = true;
    canvas.setAttribute('aria-busy', 'true');
    requestAnimationFrame(paintNow);
  };
  const paintNow = async () => {
    again = false;
    await paint();
    drawing = false;
    if (again) repaint(); else canvas.setAttribute('aria-busy', 'false');
  };
  const look = (change) => {
    change();
    follow.setAttribute('aria-pressed', String(view.follows));
    repaint();
  };
  const seek = (t) => {
    now = Math.max(start, Math.min(end, t));
    bar.value = end > start ? ((now - start) / (end - start)) * TICKS : 0;
    clock.textContent = `t = ${formatNumber(now, 4)}`;
    bar.setAttribute('aria-valuetext', clock.textContent);
    repaint();
  };
  const say = () => {
    play.textContent = playing ? '❚❚ pause' : '▶ play';
    repaint();  // sharp again
  };
  const pause = () => {
    playing = false;
    say();
  };
  const run = () => {
    if (now >= end) seek(start);
    playing = true;
    say();
    let last = performance.now();
    const tick = (at) => {
      if (!playing) return;
      seek(now + Math.max(0, Math.min(at - last, 250)) / 1000 * speed.value);
      last = at;
      if (now >= end) pause(); else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  };

  const notes = motion.missing ? [`${motion.missing} of ${times.length} poses are missing.`] : [];
  const element = figure(block, [canvas,
    h('div', { class: 'player' }, play, bar, clock, h('label', {}, 'speed ', speed), h('span', { class: 'views' }, tools)),
    notes.map((text) => h('p', { class: 'remark' }, text)), block.note ? h('p', { class: 'remark' }, inline(block.note)) : null]);
  /** The flat picture at once, the solid one when WebGL is there. */
  const draw = async () => {
    drawing = true;  // until all is set
    view.handle(canvas, look, () => (playing ? pause() : run()));
    followWidth(canvas, repaint);
    say();
    seek(start);
    look(() => view.goHome());
    paintNow();
    await afterFirstPicture();
    if (webglWorks()) stage = makeStage(motion, grid, trails, view.depth);
    else element.append(h('p', { class: 'remark' }, 'Drawn flat: this browser offers no WebGL.'));
    repaint();
  };
  return { element, draw };
}

/** 1 where the motion then takes a pleasant time, else what brings it near ten seconds. */
function speedFor(duration) {
  if (!(duration > 0) || (duration >= PLEASANT[0] && duration <= PLEASANT[1])) return 1;
  const off = (s) => Math.abs(Math.log(duration / s / 10));
  return SPEEDS.reduce((best, s) => (off(s) < off(best) ? s : best));
}

/** What both ways of drawing share: the space axes in a corner, the grid's spacing, names where bodies are several. */
function drawOverlay(context, { motion, grid, poses, seen, height, scale }) {
  const text = (words, x, y) => {
    context.strokeText(words, x, y);
    context.fillText(words, x, y);
  };
  context.setLineDash([]);
  Object.assign(context, { font: `${12 * scale}px ${FONT}`, textBaseline: 'middle', textAlign: 'center', lineJoin: 'round' });
  const corner = [34 * scale, height - 34 * scale];
  [['x', 0], ['y', 1], ['z', 2]].forEach(([name, k]) => {
    const [dx, dy] = [seen.frame.right[k], -seen.frame.up[k]];
    if (Math.hypot(dx, dy) < 0.15) return;  // it points at the eye
    Object.assign(context, { strokeStyle: '#6b7580', lineWidth: 1.4 * scale });
    context.beginPath();
    context.moveTo(...corner);
    context.lineTo(corner[0] + dx * 19 * scale, corner[1] + dy * 19 * scale);
    context.stroke();
    Object.assign(context, { strokeStyle: '#fffd', fillStyle: '#4a525c', lineWidth: 3 * scale });
    text(name, corner[0] + dx * 27 * scale, corner[1] + dy * 27 * scale);
  });
  if (grid) {
    context.textAlign = 'left';
    text(`grid ${formatShort(grid.step, 3)}`, corner[0] + 36 * scale, height - 12 * scale);
  }
  if (motion.bodies.length < 2) return;
  context.textAlign = 'center';
  motion.bodies.forEach(({ name, hull }, b) => {
    if (!poses[b]) return;
    const top = Math.min(...hull.map(({ point, air }) => seen.project(placed(poses[b], point))[1] - air * seen.unit));
    text(name, seen.project(poses[b].at)[0], top - 9 * scale);
  });
}
