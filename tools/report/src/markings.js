// What a plot shows beside its curves: the floor of round-off, moments, bands, slopes.

import { TEXT } from './chart.js';
import { extent } from './series.js';

const [UNDER, OVER] = [3, 5];  // decades around the floor: the axis of a quantity that stays at round-off
const NEAR = 3;                // decades over the floor is still round-off

export const DECADES = 2;      // so many on a logarithmic axis y: it ends at powers of ten
const LABEL = [0.22, 0.1];     // parts of the axes that the words at a line take

const line = (at, text, style = {}, position = 'insideEndTop') => ({ ...at, symbol: 'none', lineStyle: { color: 'var(--soft)', type: [5, 4], width: 1, ...style },
  label: { ...TEXT, fontSize: 11, backgroundColor: 'var(--paper)', formatter: text, position, show: Boolean(text) } });

/** The block -> {series, range: of the y axis, where it is fixed}. */
export function markings(block, shown, data) {
  const lines = (block.marks ?? []).map(({ x, text }) => line({ xAxis: x }, text));
  let range = null;
  if (block.floor > 0 && data.y.log) {
    const floor = Math.log10(block.floor);
    const [least, most] = extent(shown.flatMap((curve) => curve.points.map((p) => p[1])));
    if (!(most > floor + NEAR)) {
      const low = Number.isFinite(most) ? Math.min(floor - UNDER, most - 1) : floor - UNDER;  // also what stays far under it is seen
      range = [Math.floor(low), Math.ceil(floor + OVER)];
    }
    const [low, high] = range ?? [most - least >= DECADES ? Math.floor(least) : least - 0.1, most];
    const height = LABEL[1] * (high - low), position = clearOf(shown, floor, height);
    lines.push(line({ yAxis: floor }, 'round-off', {}, position));
    if (floor >= low && position.endsWith('Bottom') && floor - height < low) range = [Math.floor(floor - height), Math.ceil(high)];  // room for it
  }
  const bands = (block.bands ?? []).map(({ from, to, text }) => [{ xAxis: from, name: text }, { xAxis: to }]);
  const areas = bands.length ? [{ id: 'bands', name: '', type: 'line', data: [], silent: true, tooltip: { show: false }, markArea: { silent: true, data: bands,
    itemStyle: { color: 'var(--grid)', opacity: 0.6 }, label: { ...TEXT, fontSize: 11, position: 'insideTop' } } }] : [];
  const series = lines.length ? [{ id: 'marks', name: '', type: 'line', data: [], silent: true, tooltip: { show: false }, markLine: { silent: true, symbol: 'none', z: 6, data: lines } }] : [];
  return { series: [...areas, ...series, ...triangles(block.slopes, shown, data)], range };
}

/** Where words at a level stand clear of the curves: above or below it, at the right or the left end; for nowhere below at the right. */
function clearOf(shown, level, height) {
  const [left, right] = extent(shown.flatMap((curve) => curve.points.map((p) => p[0])));
  const wide = LABEL[0] * (right - left);
  const free = (from, to, low, high) => shown.every(({ points }) => {
    const first = points.findIndex((p) => p[0] >= from), behind = points.filter((p) => p[0] <= to).length;
    const [least, most] = extent(points.slice(Math.max(0, first - 1), behind + 1).map((p) => p[1]));
    return first < 0 || !(least < high && most > low);
  });
  const ends = [['End', right - wide, right], ['Start', left, left + wide]];
  const sides = [['Top', level, level + height], ['Bottom', level - height, level]];
  for (const [side, low, high] of sides)
    for (const [end, from, to] of ends) if (free(from, to, low, high)) return `inside${end}${side}`;
  return 'insideEndBottom';
}

/** A triangle of each slope, under the curves, over the middle third of the x axis. */
function triangles(slopes, shown, { x, y }) {
  if (!slopes?.length || !x.log || !y.log) return [];
  const points = shown.flatMap((curve) => curve.points.filter((p) => p[0] !== null && p[1] !== null));
  const [left, right] = extent(points.map((p) => p[0]));
  if (!(right > left)) return [];
  const [from, to] = [0.55, 0.8].map((part) => left + part * (right - left));
  return slopes.map((slope, i) => {
    const low = Math.min(...points.filter((p) => p[0] >= from - 0.01).map((p) => p[1])) - 0.6 * (i + 1);
    const [middle, top] = [0.5, 1].map((part) => low + part * slope * (to - from));
    return { id: `slope ${slope}`, name: '', type: 'line', data: [[to, middle], [to, top], [from, low], [to, low], [to, middle]], silent: true, showSymbol: false,
      tooltip: { show: false }, lineStyle: { color: 'var(--soft)', width: 1 }, endLabel: { ...TEXT, show: true, fontSize: 11, formatter: `slope ${slope}`, distance: 4 } };
  });
}
