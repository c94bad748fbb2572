// Bodies that move: a rolling disk, a ball on its table, a sleigh with a trailer from above, a body that turns.

const range = (n, at) => Array.from({ length: n }, (_, i) => at(i));
const about = (axis, angle) => [Math.cos(angle / 2), ...axis.map((v) => v * Math.sin(angle / 2))];
const times4 = ([a, b, c, d], [e, f, g, k]) => [a * e - b * f - c * g - d * k, a * f + b * e + c * k - d * g,
  a * g - b * k + c * e + d * f, a * k + b * g - c * f + d * e];
const seconds = (n, end) => range(n, (i) => +((i * end) / (n - 1)).toFixed(6));

const disk = () => {
  const times = seconds(240, 12);
  let [x, y, heading, roll] = [0, 0, 0, 0];
  const tilt = 0.35;
  const poses = times.map((t) => {
    const dt = 0.05;
    heading += 0.6 * dt * (1 + 0.5 * Math.sin(t));
    x += dt * Math.cos(heading);
    y += dt * Math.sin(heading);
    roll += dt / 0.5;
    const turn = times4(times4(about([0, 0, 1], heading), about([1, 0, 0], -tilt)), about([0, 1, 0], roll));
    return [x, y, 0.5 * Math.cos(tilt), ...turn];
  });
  return { kind: 'animation', title: 'Rolling disk', view: '3d', times, floor: true, note: 'The trail is that of the centre.',
    forces: [{ name: 'ground', modes: times.map((t) => (t < 6 ? 2 : 1)), cone: { friction: 0.25, normals: [[0, 0, 1]] }, values: poses.map(([px, py], i) => [px, py, 0, 2 * Math.cos(times[i]), 2 * Math.sin(times[i]), 9.81]) }],
    bodies: [{ name: 'disk', poses, trail: true, trail_point: [0, 0, 0], shapes: [{ shape: 'cylinder', radius: 0.5, length: 0.06, axis: [0, 1, 0], color: 'accent' }] }] };
};

const ball = () => {
  const times = seconds(300, 30);
  const poses = times.map((t) => [1.5 + Math.cos(t * 0.7), 0.6 * Math.sin(t * 0.7), 0.2,
    ...times4(about([0, 0, 1], 0.4 * t), about([0, 1, 0], 1.3 * t))]);
  const table = times.map((t) => [1.2, 0, 0, ...about([0, 0, 1], 0.5 * t)]);
  return { kind: 'animation', title: 'Ball on a turntable', view: '3d', times, floor: true, bodies: [
    { name: 'ball', poses, trail: true, trail_point: [0, 0, 0], shapes: [{ shape: 'sphere', radius: 0.2 }] },
    { name: 'table', poses: table, shapes: [{ shape: 'cylinder', radius: 1.8, length: 0.05, at: [0, 0, -0.025], color: 'light' }] }] };
};

const sleigh = () => {
  const times = seconds(200, 100);
  let [x, y] = [0, 0];
  const heading = (t) => 1.2 * Math.sin(t / 9);
  const front = times.map((t) => {
    [x, y] = [x + 0.12 * Math.cos(heading(t)), y + 0.12 * Math.sin(heading(t))];
    return [x, y, 0, ...about([0, 0, 1], heading(t))];
  });
  const back = times.map((t, i) => (i < 15 ? [-0.9 - 0.12 * (15 - i), 0, 0, 1, 0, 0, 0] : front[i - 15]));
  return { kind: 'animation', title: 'Sleigh and trailer from above', view: 'top', times, floor: true, bodies: [
    { name: 'sleigh', poses: front, trail: true, shapes: [{ shape: 'box', size: [1, 0.5, 0.1], at: [0.1, 0, 0.05] },
      { shape: 'line', points: [[-0.4, 0, 0.12], [0.2, 0, 0.12]], color: 'dark' }, { shape: 'arrow', to: [0.9, 0, 0], at: [0, 0, 0.13], color: 'accent' }] },
    { name: 'trailer', poses: back, trail: true, shapes: [{ shape: 'box', size: [0.7, 0.4, 0.1], at: [0, 0, 0.05], color: 'light' }] }] };
};

export const body = () => {
  const times = seconds(400, 60);
  const poses = times.map((t, i) => (i > 360 ? [0, 0, 0, null, null, null, null]
    : [0, 0, 0, ...times4(about([0.6, 0, 0.8], 0.5 * t), about([1, 0, 0], 0.3 * Math.sin(t)))]));
  return { kind: 'animation', title: 'Body that turns', view: '3d', times, floor: false, bodies: [{ name: 'body', poses, trail: true, trail_point: [0, 0, 1.5],
    shapes: [{ shape: 'ellipsoid', radii: [1, 0.7, 0.45] }, { shape: 'arrow', to: [1.5, 0, 0], color: 'dark' }, { shape: 'arrow', to: [0, 1.5, 0], color: 'dark' },
      { shape: 'arrow', to: [0, 0, 1.5], color: '#d55e00' }] }] };
};

/** Far longer than the disk is large: the view follows it. */
const far = () => {
  const one = disk();
  one.bodies[0].poses = one.bodies[0].poses.map(([, , z, ...turn], i) => [i * 0.25, 0, z, ...turn]);
  one.forces[0].values = one.forces[0].values.map(([, , ...rest], i) => [i * 0.25, 0, ...rest]);
  return { ...one, title: 'Rolling far' };
};

export const motion = { title: 'Animation', blocks: [disk(), ball(), sleigh(), body(), far()] };
