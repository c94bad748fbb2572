// The motion of a run from the module: shapes as JSON, the rest as one array of numbers -> the block of an animation.

const POSE = 7;   // x y z qw qx qy qz
const FORCE = 6;  // where it acts, the force

/** `count` lists of `size` numbers from `at` on. */
const lists = (numbers, at, count, size) => Array.from({ length: count }, (_, i) => Array.from(numbers.subarray(at + i * size, at + (i + 1) * size)));

/** The block, complete; null of a run without a drawing. */
export function motionOf(block, numbers) {
  if (!block) return null;
  const count = block.times;
  const times = Array.from(numbers.subarray(0, count));
  let at = count;
  const take = (size) => {
    const taken = lists(numbers, at, count, size);
    at += count * size;
    return taken;
  };
  const bodies = block.bodies.map((body) => ({ ...body, poses: take(POSE) }));
  const forces = (block.forces ?? []).map((force) => ({ ...force, values: take(FORCE) }));
  return { ...block, times, bodies, ...(forces.length ? { forces } : {}) };
}

/** Poses of a run that is driven, [time, x y z qw qx qy qz of each body] -> [{at, turn}, …]. */
export const posesOf = (numbers) => lists(numbers, 1, (numbers.length - 1) / POSE, POSE).map((pose) => ({ at: pose.slice(0, 3), turn: pose.slice(3) }));

/** Can a motion be shown in the place of another: the same bodies, shaped alike, the same forces? */
export const alike = (a, b) => Boolean(a && b) && a.view === b.view && a.bodies.length === b.bodies.length &&
  a.bodies.every((body, i) => body.name === b.bodies[i].name) && (a.forces?.length ?? 0) === (b.forces?.length ?? 0);
