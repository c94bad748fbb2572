// The figure `animation`: bodies that move, with play, a bar to scrub, speed, and a view turned by dragging or keys.

import { Color, Group, Matrix4, Mesh, MeshBasicMaterial, Scene, SphereGeometry, Vector3 } from 'three';
import { colourOfMode, MODES } from '../charts/palette.js';
import { h } from '../dom.js';
import { figure, remark } from '../figure.js';
import { formatNumber, formatShort } from '../format.js';
import { arrowOf, coneOf, contactAt, floorGrid, middleOf, placed, placeInTime, poseAt, readMotion, roomOf } from './motion.js';
import { columnsToCsv } from '../save.js';
import { addLight, lines, pairs, solids, stand, styled } from './shapes.js';
import { ABOVE, HOME, Stage, warm as warmStage } from './stage.js';

const heightFor = (width) => Math.round(Math.max(250, Math.min(380, 0.75 * width)));
const TICKS = 1000;       // of the bar
const SPEEDS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
const PLEASANT = [4, 25]; // seconds that a motion may take as it is; others are brought near 10
const TRAILS = ['--c2', '--c1', '--c3', '--c4', '--c6', '--c8'];
const DOT = 0.035;        // of the reach of all bodies: the radius of a contact
const ARROW = 0.15;       // of what is seen, and the reach of all bodies at least: the length of the strongest force
// So many times this reach is the room before they are followed at first, and is seen around them then.
const FAR = (bodies) => (bodies.length > 1 ? 7 : 40);
const AROUND = (bodies) => (bodies.length > 1 ? 1.2 : 3.2);

export function animation(block, { height = heightFor } = {}) {
  let { motion, times, bodies, start, end, room, long, grid } = spread(block);
  let [now, playing, pushing, live, ghosts] = [start, false, false, null, []];
  const poses = () => live ?? bodies.map((body) => poseAt(body, placeInTime(times, now)));

  const holder = h('div', { class: 'stage3d drawing', role: 'img', tabindex: 0, 'aria-label':
    `Animation: ${block.title ?? 'untitled'}; ${bodies.map((body) => body.name).join(', ')}; t from ${formatShort(start)} to ` +
    `${formatShort(end)}. Space plays, arrow keys turn the view, plus and minus zoom, 0 resets.` });
  const stage = new Stage(holder, { height, box: motion.box, from: block.view === 'top' ? ABOVE : HOME, floor: Boolean(block.floor),
    build: (solid) => build(motion, grid, solid, poses, () => placeInTime(times, now), () => pushing, long ? AROUND(bodies) * motion.reach : room, ghosts) });
  const bar = h('input', { type: 'range', class: 'bar', min: 0, max: TICKS, value: 0, 'aria-label': 'time',
    oninput: () => { pause(); seek(start + (bar.value / TICKS) * (end - start)); } });
  const clock = h('output', { class: 'clock' });
  const play = h('button', { type: 'button', class: 'play', onclick: () => (playing ? pause() : run()) });
  const speed = h('select', { 'aria-label': 'speed' }, SPEEDS.map((s) => h('option', { value: s }, `${s}×`)));
  speed.value = speedFor(end - start);
  const where = () => new Vector3(...middleOf(bodies, poses()));
  const follow = (yes) => {
    stage.follow(yes ? where : null, AROUND(bodies) * motion.reach);
    button.setAttribute('aria-pressed', String(yes));
  };
  const button = h('button', { type: 'button', onclick: () => follow(button.getAttribute('aria-pressed') !== 'true') }, 'follow');
  const tools = [h('button', { type: 'button', onclick: () => stage.goTo(ABOVE) }, 'from above'), button,
    h('button', { type: 'button', class: 'home', onclick: () => { follow(long); stage.goTo(stage.from); } }, 'reset view')];

  if (motion.strongest > 0) {
    const push = h('button', { type: 'button', 'aria-pressed': 'false', onclick: () => {
      pushing = !pushing;
      push.setAttribute('aria-pressed', String(pushing));
      stage.paint();
    } }, 'reactions');
    tools.unshift(push);
  }

  const seek = (t) => {
    now = Math.max(start, Math.min(end, t));
    bar.value = end > start ? ((now - start) / (end - start)) * TICKS : 0;
    clock.textContent = `t = ${formatNumber(now, 4)}`;
    bar.setAttribute('aria-valuetext', clock.textContent);
    stage.paint();
  };
  const say = () => { play.textContent = playing ? '❚❚ pause' : '▶ play'; };
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
  holder.addEventListener('keydown', (event) => {
    if (event.key !== ' ') return;
    event.preventDefault();
    if (playing) pause(); else run();
  });

  const csv = () => columnsToCsv([{ name: 't', values: times }, ...bodies.flatMap(({ name }, b) => ['x', 'y', 'z', 'qw', 'qx', 'qy', 'qz'].map((axis, k) =>
    ({ name: `${name} ${axis}`, values: block.bodies[b].poses.map((pose) => pose?.[k]) })))]);
  const element = figure(block, [holder,
    h('div', { class: 'player' }, play, bar, clock, h('label', {}, 'speed ', speed), h('span', { class: 'views' }, tools)),
    motion.missing ? remark(`${motion.missing} of ${times.length} poses are missing.`) : null, block.note ? remark(block.note) : null], { svg: () => stage.picture(false), png: () => stage.picture(true), csv });
  const draw = () => {
    say();
    return stage.draw(() => {
      follow(long);
      seek(start);
    });
  };
  /** Shows another motion of as many bodies from where the eye is, at about the same time; anew where the one before had ended. */
  const show = (other) => {
    const over = now >= end;
    block = other;
    ({ motion, times, bodies, start, end, room, long, grid } = spread(block));
    live = null;
    stage.see(motion.box);
    seek(now);
    if (over && !playing) run();
  };
  /** Shows the bodies in these poses, [{at, turn}, …], at a time t, whatever the motion is. */
  const feed = (t, given) => {
    if (playing) pause();
    [live, now] = [given, t];
    clock.textContent = `t = ${formatNumber(t, 4)}`;
    stage.paint();
  };
  const dispose = () => {
    pause();
    stage.dispose();
  };
  const posesAt = (t) => bodies.map((body) => poseAt(body, placeInTime(times, t)));
  /** Shows the motion at t, with the bodies at the earlier times `before` beside it: all of them are then in sight. */
  const hold = (t, before = []) => {
    ghosts = before.map(posesAt);
    const many = ghosts.length > 0;
    follow(long && !many);
    seek(t);
    if (many) stage.see(roomOf(bodies, bodies.map((_, b) => [...ghosts, posesAt(t)].map((at) => at[b])), block.floor));
    else stage.rebuild();
  };
  /** Frames, to be drawn one after the other, each once: (t, before) -> canvas. */
  const film = (sharper, transparent) => {
    const take = stage.film(sharper, transparent);
    let begun = false;
    return (t, before = []) => {
      stage.unpainted(() => { if (begun && before.length === 0) seek(t); else hold(t, before); });
      begun = before.length === 0;
      return take();
    };
  };
  return { element, draw, picture: () => stage.picture(false), show, feed, follow, hold, film, play: run, dispose };
}

/** Makes the next animation ready to be drawn by WebGL: its shaders, while the page waits for its data. */
export const warm = () => warmStage(() => {
  const scene = new Scene();
  addLight(scene, true);
  scene.add(...solids({ shape: 'box', size: [1, 1, 1], colour: styled('--c1') }, true), new Mesh(new SphereGeometry(1), new MeshBasicMaterial()));
  return scene;
});

/** A motion, its times and bodies, its room, whether that is long against the bodies, the grid on the floor. */
function spread(block) {
  const motion = readMotion(block);
  const { times, bodies } = motion;
  const room = Math.max(...motion.box[1].map((v, i) => v - motion.box[0][i]));
  const long = room > FAR(bodies) * motion.reach;
  const grid = block.floor ? floorGrid(motion.box, long ? 0.47 * AROUND(bodies) * motion.reach : 0) : null;
  return { motion, times, bodies, start: times[0], end: times[times.length - 1], room, long, grid };
}

/** 1 where the motion then takes a pleasant time, else what brings it near ten seconds. */
function speedFor(duration) {
  if (!(duration > 0) || (duration >= PLEASANT[0] && duration <= PLEASANT[1])) return 1;
  const off = (s) => Math.abs(Math.log(duration / s / 10));
  return SPEEDS.reduce((best, s) => (off(s) < off(best) ? s : best));
}

/** The colours of a body, so far on their way to the paper. */
function faded(group, far) {
  const paper = styled('--paper');
  const materials = new Set();  // parts share them
  group.traverse(({ material }) => material && materials.add(material));
  materials.forEach(({ color }) => color.lerp(paper, far));
  return group;
}

/** The scene at the time `now`: grid, shadows straight down on it, bodies, and the ways of points: all thin, the past strong. */
function build(motion, grid, solid, poses, now, pushing, seen, ghosts) {
  const scene = new Scene();
  const light = addLight(scene, solid);
  if (grid) scene.add(lines(solid, grid.lines.flat(2), styled('--mesh'), 0.9, { renderOrder: -3 }));
  const made = ({ shapes }) => {
    const group = new Group();
    for (const shape of shapes) {
      const part = stand(new Group(), shape.pose);
      solids(shape, solid).forEach((piece) => part.add(piece));
      group.add(part);
    }
    return group;
  };
  const groups = motion.bodies.map(made);
  scene.add(...groups);
  const past = ghosts.flatMap((at, i) => motion.bodies.flatMap((body, b) => (at[b] ? [faded(stand(made(body), at[b]), 0.65 * (1 - i / ghosts.length))] : [])));
  if (past.length) scene.add(...past);
  past.forEach((body) => body.updateMatrixWorld(true));
  const flatten = new Matrix4().makeScale(1, 1, 0);
  const shadows = [];
  const dark = new MeshBasicMaterial({ color: styled('--shadow'), depthWrite: false });
  if (grid) [...groups, ...past].forEach((body) => body.traverse((part) => {
    if (!part.isMesh || part.isLineSegments2) return;  // lines cast none
    shadows.push({ part, body, shadow: Object.assign(new Mesh(part.geometry, dark), { matrixAutoUpdate: false, renderOrder: -2, frustumCulled: false }) });
  }));
  shadows.forEach(({ shadow }) => scene.add(shadow));
  const trails = motion.bodies.map(({ way, point }, b) => {
    if (!way) return null;
    const colour = styled(TRAILS[b % TRAILS.length]);
    const behind = lines(solid, [], colour, 2.2);
    scene.add(lines(solid, pairs(way), new Color(colour).lerp(styled('--paper'), 0.5), 1.3, { renderOrder: -1, depthWrite: false }), behind);
    return (pose, { i }) => behind.place(pairs([...way.slice(0, i + 1), pose ? placed(pose, point) : null]));
  });
  const scale = Math.max(motion.reach, ARROW * seen) / motion.strongest;
  const arrows = motion.forces.map(() => lines(solid, [], styled('--ink'), 3, { depthTest: false, renderOrder: 1 }));
  if (arrows.length) scene.add(...arrows);
  const cones = motion.forces.filter(({ cone }) => cone).map((force) => ({ force, drawn: lines(solid, [], styled('--ink'), 1.6, { depthTest: false, renderOrder: 1 }) }));
  cones.forEach(({ drawn }) => scene.add(drawn));
  const dots = motion.forces.filter(({ modes }) => modes.length).map((force) => {
    const dot = new Mesh(new SphereGeometry(DOT * motion.reach, solid ? 20 : 8, solid ? 12 : 6), new MeshBasicMaterial());
    return { force, dot };
  });
  dots.forEach(({ dot }) => scene.add(dot));
  const update = (camera) => {
    light(camera);
    arrows.forEach((arrow, f) => arrow.place(pushing() ? arrowOf(motion.forces[f], now(), scale) : []));
    for (const { force, drawn } of cones) {
      drawn.place(pushing() ? coneOf(force, now(), scale) : []);
      drawn.material.color.copy(styled(colourOfMode(MODES[contactAt(force, now())?.mode]) ?? '--ink'));
    }
    const at = poses();
    for (const { force, dot } of dots) {
      const contact = contactAt(force, now());
      dot.visible = Boolean(contact);
      if (!contact) continue;
      dot.position.set(...contact.at);
      dot.material.color.copy(styled(colourOfMode(MODES[contact.mode] ?? MODES[0])));
    }
    groups.forEach((body, b) => {
      body.visible = Boolean(at[b]);
      if (at[b]) stand(body, at[b]).updateMatrixWorld(true);
      trails[b]?.(at[b], now());
    });
    for (const { part, body, shadow } of shadows) {
      shadow.visible = body.visible;
      shadow.matrix.multiplyMatrices(flatten, part.matrixWorld);
    }
  };
  const top = (pose, { hull }) => [pose.at[0], pose.at[1], Math.max(...hull.map(({ point, air }) => placed(pose, point)[2] + air))];
  const labels = motion.bodies.length < 2 || ghosts.length ? [] : motion.bodies.map((body, b) =>
    ({ text: body.name, up: 9, at: () => { const pose = poses()[b]; return pose ? top(pose, body) : [NaN, NaN, NaN]; } }));
  return { scene, update, labels, scale: grid ? `grid ${formatShort(grid.step, 3)}` : '' };
}
