// Moving bodies as data: poses at times, what lies between them, ways of points, and how much room all of it takes.
// A pose is {at: [x, y, z], turn: [w, x, y, z]}; null where a pose is missing.

const COLOURS = { body: '#4d86bd', accent: '#d55e00', dark: '#2f3a46', light: '#dfe5ec' };
const NEEDS = { box: 'size', cylinder: 'radius', wheel: 'radius', sphere: 'radius', ellipsoid: 'radii', line: 'points', arrow: 'to' };

const TOUCHING = 0.02;  // of the radius: what rolls inside a shell
const SIDES = 36, SPOKE = 6;  // of the rim of a cone; every so many a line to it
const WIDE = 2;         // a cone of more friction is lower than its force

export const add = (a, b) => a.map((v, i) => v + b[i]);
const isPoint = (p) => Array.isArray(p) && p.length === 3 && p.every(Number.isFinite);

/** The vector v turned by the unit quaternion q. */
export function turned([w, x, y, z], [a, b, c]) {
  const [p, q, r] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * p + y * r - z * q, b + w * q + z * p - x * r, c + w * r + x * q - y * p];
}

/** A point of the body in space. */
export const placed = (pose, point) => add(pose.at, turned(pose.turn, point));

/** The rotation that takes the z axis to `axis` (any length) on the shortest way. */
export function turnFromZ(axis) {
  const length = Math.hypot(...axis);
  const [x, y, z] = axis.map((v) => v / length);
  if (z < -1 + 1e-9) return [0, 1, 0, 0];
  const w = Math.sqrt((1 + z) / 2);
  return [w, -y / (2 * w), x / (2 * w), 0];
}

/** Between two unit quaternions, evenly along the shorter arc. */
export function slerp(p, q, u) {
  let cosine = p.reduce((sum, v, i) => sum + v * q[i], 0);
  const sign = cosine < 0 ? -1 : 1;
  cosine *= sign;
  const angle = Math.acos(Math.min(1, cosine));
  const [a, b] = angle < 1e-6 ? [1 - u, u] : [Math.sin((1 - u) * angle), Math.sin(u * angle)].map((v) => v / Math.sin(angle));
  const mixed = p.map((v, i) => a * v + sign * b * q[i]);
  const size = Math.hypot(...mixed);
  return mixed.map((v) => v / size);
}

function readPose(numbers) {
  if (!Array.isArray(numbers) || numbers.length !== 7 || !numbers.every(Number.isFinite)) return null;
  const size = Math.hypot(...numbers.slice(3));
  return size > 0 ? { at: numbers.slice(0, 3), turn: numbers.slice(3).map((v) => v / size) } : null;
}

function readShape(shape, where) {
  const need = Object.hasOwn(NEEDS, shape?.shape) ? NEEDS[shape.shape] : null;
  if (!need) throw new Error(`${where}: unknown shape “${shape?.shape}”; known are ${Object.keys(NEEDS).join(', ')}`);
  const value = shape[need];
  const good = need === 'radius' ? Number.isFinite(value) : need === 'points' ? Array.isArray(value) && value.every(isPoint) : isPoint(value);
  if (!good) throw new Error(`${where}: a ${shape.shape} needs “${need}”`);
  if ((shape.shape === 'cylinder' || shape.shape === 'wheel') && !Number.isFinite(shape.length)) throw new Error(`${where}: a ${shape.shape} needs “length”`);
  const name = shape.color ?? 'body';
  const colour = Object.hasOwn(COLOURS, name) ? COLOURS[name] : name;
  if (!/^#[0-9a-f]{6}$/i.test(colour)) {
    throw new Error(`${where}: unknown color “${name}”; known are ${Object.keys(COLOURS).join(', ')} and #rrggbb`);
  }
  const axis = isPoint(shape.axis) && Math.hypot(...shape.axis) > 0 ? shape.axis : [0, 0, 1];
  return { ...shape, colour, pose: { at: isPoint(shape.at) ? shape.at : [0, 0, 0], turn: turnFromZ(axis) } };
}

/** Points of a shape, in its own frame, that its hull goes around; `air` around them. */
function hullOf(shape) {
  const corners = (sizes) => [0, 1, 2, 3, 4, 5, 6, 7].map((k) => sizes.map((v, i) => ((k >> i) & 1 ? v : -v)));
  switch (shape.shape) {
    case 'box': return { points: corners(shape.size.map((v) => v / 2)), air: 0 };
    case 'cylinder': case 'wheel': return { points: [0, 1, 2, 3, 4, 5, 6, 7].flatMap((k) => [-0.5, 0.5].map((z) =>
      [shape.radius * Math.cos((k * Math.PI) / 4), shape.radius * Math.sin((k * Math.PI) / 4), z * shape.length])), air: 0 };
    case 'sphere': return { points: [[0, 0, 0]], air: shape.radius };
    case 'ellipsoid': return { points: corners(shape.radii.map((v) => v * Math.SQRT1_2)), air: 0 };
    case 'line': return { points: shape.points, air: 0 };
    default: return { points: [[0, 0, 0], shape.to], air: 0 };
  }
}

/** The mean of where the middles of bodies are; one without a pose counts for nothing. */
export function middleOf(bodies, poses) {
  const here = bodies.flatMap((body, b) => (poses[b] ? [placed(poses[b], body.middle)] : []));
  return here.reduce((sum, at) => add(sum, at.map((v) => v / here.length)), [0, 0, 0]);
}

function readForce(force, f, times) {
  const { values } = force ?? {};
  const where = `force ${f + 1} (${force?.name})`;
  if (!Array.isArray(values) || values.length !== times.length) throw new Error(`${where} needs a list of ${times.length} values`);
  const modes = force.modes ?? [];
  if (modes.length && modes.length !== times.length) throw new Error(`${where} needs a mode for each of ${times.length} times`);
  const normals = force.cone?.normals ?? [];
  if (normals.length > 1 && normals.length !== times.length) throw new Error(`${where} needs one normal of its cone, or ${times.length}`);
  const cone = normals.length ? { friction: force.cone.friction, normals } : null;
  return { name: String(force.name ?? ''), modes, cone, values: values.map((v) =>
    (Array.isArray(v) && v.length === 6 && v.every(Number.isFinite) ? { at: v.slice(0, 3), force: v.slice(3) } : null)) };
}

/** Marks the balls that hold a whole other body in the first pose: one sees through them. */
function markShells(bodies) {
  const within = (shape, pose, { point, air }) => {
    const back = ([w, ...v]) => [w, ...v.map((c) => -c)];
    const apart = (p, from) => p.map((v, i) => v - from.at[i]);
    const p = turned(back(shape.pose.turn), apart(turned(back(pose.turn), apart(point, pose)), shape.pose));
    const radii = shape.radii ?? Array(3).fill(shape.radius);
    return Math.hypot(...p.map((v, i) => v / radii[i])) + air / Math.min(...radii) < 1 + TOUCHING;
  };
  for (const { shapes, poses: [pose] } of bodies) {
    for (const shape of shapes) {
      shape.shell = Boolean(pose && (shape.radii || shape.shape === 'sphere')) && bodies.some(({ shapes: others, hull, poses: [other] }) =>
        others !== shapes && hull.length > 0 && other && hull.every(({ point, air }) => within(shape, pose, { point: placed(other, point), air })));
    }
  }
}

/** The box around bodies in these poses, a list for each of them, and around further points. */
export function roomOf(bodies, poses, floor, points = []) {
  const box = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  const take = (point, air) => point.forEach((v, i) => {
    box[0][i] = Math.min(box[0][i], v - air);
    box[1][i] = Math.max(box[1][i], v + air);
  });
  bodies.forEach(({ hull }, b) => {
    for (const pose of poses[b]) if (pose) hull.forEach(({ point, air }) => take(placed(pose, point), air));
  });
  points.forEach((point) => point && take(point, 0));
  if (floor) [box[0][2], box[1][2]] = [Math.min(0, box[0][2]), Math.max(0, box[1][2])];
  return box[0][0] < Infinity ? box : [[-1, -1, -1], [1, 1, 1]];
}

/** The block -> {times, bodies, forces, strongest, box, reach, missing}; a body: {name, poses, shapes, hull, middle, way: points or null, reach}. */
export function readMotion(block) {
  const { times } = block;
  if (!Array.isArray(times) || times.length === 0) throw new Error('no list "times"');
  if (times.some((t, i) => !Number.isFinite(t) || (i > 0 && t <= times[i - 1]))) throw new Error('"times" do not rise');
  if (!Array.isArray(block.bodies) || block.bodies.length === 0) throw new Error('no list "bodies"');
  const bodies = block.bodies.map((body, b) => {
    const where = `body ${b + 1} (${body?.name})`;
    if (!Array.isArray(body?.poses) || !Array.isArray(body.shapes)) throw new Error(`${where} needs the lists poses and shapes`);
    if (body.poses.length !== times.length) throw new Error(`${where} has ${body.poses.length} poses for ${times.length} times`);
    const poses = body.poses.map(readPose);
    const shapes = body.shapes.map((shape) => readShape(shape, where));
    const hull = shapes.flatMap((shape) => {
      const { points, air } = hullOf(shape);
      return points.map((p) => ({ point: placed(shape.pose, p), air }));
    });
    const middle = [0, 1, 2].map((k) => (Math.min(...hull.map((p) => p.point[k])) + Math.max(...hull.map((p) => p.point[k]))) / 2 || 0);
    const point = isPoint(body.trail_point) ? body.trail_point : [0, 0, 0];
    return { name: String(body.name ?? ''), poses, shapes, point, hull, middle,
      way: body.trail ? poses.map((pose) => (pose ? placed(pose, point) : null)) : null,
      reach: Math.max(0, ...hull.map((p) => Math.hypot(...p.point.map((v, k) => v - middle[k])) + p.air)) };
  });
  markShells(bodies);
  const box = roomOf(bodies, bodies.map(({ poses }) => poses), block.floor, bodies.flatMap(({ way }) => way ?? []));
  const forces = (block.forces ?? []).map((force, f) => readForce(force, f, times));
  const strongest = Math.max(0, ...forces.flatMap(({ values }) => values.map((v) => (v ? Math.hypot(...v.force) : 0))));
  const apart = times.map((_, i) => {
    const middle = middleOf(bodies, bodies.map(({ poses }) => poses[i]));
    return Math.max(0, ...bodies.filter(({ poses }) => poses[i]).map((body) => body.reach + Math.hypot(...placed(body.poses[i], body.middle).map((v, k) => v - middle[k]))));
  });
  return { times, bodies, forces, strongest, box, reach: Math.max(1e-9, ...apart),
    missing: Math.max(...bodies.map((body) => body.poses.filter((pose) => !pose).length)) };
}

/** Where a time stands between the nodes: {i, u}, u from 0 to 1 on the way from node i to i + 1. */
export function placeInTime(times, t) {
  let [low, high] = [0, times.length - 1];
  if (high === 0) return { i: 0, u: 0 };
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle; else high = middle;
  }
  return { i: low, u: Math.max(0, Math.min(1, (t - times[low]) / (times[high] - times[low]))) };
}

/** A body's pose there; null in a gap. */
export function poseAt({ poses }, { i, u }) {
  const [a, b] = [poses[i], poses[i + 1] ?? null];
  if (u === 0) return a;
  if (u === 1 || !a || !b) return u === 1 ? b : null;
  return { at: a.at.map((v, k) => v + u * (b.at[k] - v)), turn: slerp(a.turn, b.turn, u) };
}

const nearest = (list, { i, u }) => list[u > 0.5 && i + 1 < list.length ? i + 1 : i];

/** Where a contact is at a time, and its mode: {at, mode}, or null. */
export function contactAt({ values, modes }, place) {
  const [now, mode] = [nearest(values, place), modes[place.i]];
  return now && Number.isFinite(mode) ? { at: now.at, mode } : null;
}

/** A force at a time, as the segments of an arrow; `scale` metres a newton. */
export function arrowOf({ values }, place, scale) {
  const now = nearest(values, place);
  if (!now) return [];
  const along = now.force.map((v) => v * scale);
  const length = Math.hypot(...along);
  if (!(length > 0)) return [];
  const tip = add(now.at, along);
  const turn = turnFromZ(along);
  const barb = (x) => add(tip, turned(turn, [x, 0, -2 * Math.abs(x)]));
  return [...now.at, ...tip, ...tip, ...barb(0.08 * length), ...tip, ...barb(-0.08 * length)];
}

/** The cone of Coulomb's friction around a force at a time, as high as its normal part, as segments: a circle and lines to it. */
export function coneOf({ values, cone }, place, scale) {
  const now = nearest(values, place);
  const normal = cone && (cone.normals.length > 1 ? nearest(cone.normals, place) : cone.normals[0]);
  if (!now || !normal?.every(Number.isFinite)) return [];
  const height = scale * now.force.reduce((sum, v, i) => sum + v * normal[i], 0);
  if (!(height > 0)) return [];
  const turn = turnFromZ(normal);
  const [top, radius] = [height, cone.friction * height].map((v) => v * Math.min(1, WIDE / cone.friction));
  const rim = Array.from({ length: SIDES }, (_, i) => add(now.at, turned(turn, [radius * Math.cos((2 * Math.PI * i) / SIDES), radius * Math.sin((2 * Math.PI * i) / SIDES), top])));
  return rim.flatMap((point, i) => [...point, ...rim[(i + 1) % SIDES], ...(i % SPOKE ? [] : [...now.at, ...point])]);
}

/** The grid under the box, a hair below z = 0: {step, lines: [[from, to], …]}; its step about `wanted` or larger. */
export function floorGrid([low, high], wanted = 0) {
  const size = Math.max(high[0] - low[0], high[1] - low[1]);
  const least = wanted > 0 ? Math.max(wanted, size / 150) : size / 12;
  const decade = 10 ** Math.floor(Math.log10(least));
  const step = decade * [1, 2, 5, 10].find((factor) => factor * decade >= least * 0.999);
  const z = -0.003 * step;
  const [x, y] = [0, 1].map((k) => [Math.floor(low[k] / step - 0.2), Math.ceil(high[k] / step + 0.2)]);
  const grid = [];
  for (let i = x[0]; i <= x[1]; ++i) grid.push([[i * step, y[0] * step, z], [i * step, y[1] * step, z]]);
  for (let i = y[0]; i <= y[1]; ++i) grid.push([[x[0] * step, i * step, z], [x[1] * step, i * step, z]]);
  return { step, lines: grid };
}
