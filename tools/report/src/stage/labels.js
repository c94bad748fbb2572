// Names beside what moves: one that would cover another moves up, and is left out where it would move far.

const TALL = 13;       // pixels of a name
const MOST_MOVES = 1.5;
const NEARLY = 0.01;   // names above one another stand TALL apart, but for round-off

/** [{across, down, half}, …], the middles of names and half their widths, in pixels -> how far down each stands, null of one that is left out. */
export function spreadNames(names) {
  const taken = [];
  return names.map(({ across, down: first, half }) => {
    let down = first;
    const covered = () => taken.find((other) => Math.abs(other.across - across) < other.half + half + 3 && Math.abs(other.down - down) < TALL - NEARLY);
    for (let other = covered(); other; other = covered()) down = other.down - TALL;
    if (first - down > MOST_MOVES * TALL) return null;
    taken.push({ across, down, half });
    return down;
  });
}
