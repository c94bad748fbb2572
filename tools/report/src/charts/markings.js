// What a plot shows beside its curves: the floor of round-off, moments, bands, slopes.

import { TEXT } from './chart.js';
import { extent } from './series.js';

const [UNDER, OVER] = [3, 5];  // decades around the floor: the axis of a quantity that stays at round-off
const NEAR = 3;                // decades over the floor is still round-off

export const DECADES = 2;      // so many on a logarithmic axis y: it ends at powers of ten
const LABEL = [0.22, 0.1];     // parts of the axes that the words at a line take
const WIDE = 0.45;             // of the place of a triangle: behind it are its words
const APART = 14;              // pixels from a moment to the next whose words stand beside its own

const line = (at, text, style = {}, position = 'insideEndTop') => ({ ...at, symbol: 'none', lineStyle: { color: 'var(--soft)', type: [5, 4], width: 1, ...style },
  label: { ...TEXT, fontSize: 11, backgroundColor: 'var(--paper)', formatter: text, position, show: Boolean(text) } });

/** The block -> {series, range: of the y axis, where it is fixed, least: what it reaches down to}; seen: the range of x, wide: its pixels. */
export function markings(block, shown, data, seen, wide) {
  const lines = moments(block.marks ?? [], seen, wide).map(({ x, words, behind }) => line({ xAxis: x }, words, {}, behind ? 'insideEndBottom' : 'insideEndTop'));
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
  const slopes = triangles(block.slopes, shown, data);
  return { series: [...areas, ...series, ...slopes.series], range, least: slopes.least };
}

/**
 * Marks in the order of x with the words beside their lines: before them, where the axis is too near behind. Those of moments too near for words of their own
 * are counted in the words before.
 */
export function moments(marks, [from, to], wide) {
  const apart = (APART * (to - from)) / wide;
  const out = [];
  let first = null;
  for (const { x, text } of [...marks].sort((a, b) => a.x - b.x).filter((mark) => mark.x >= from && mark.x <= to)) {
    if (first && x - first.x < apart * (first.behind ? 2 : 1)) {
      ++first.more;
      out.push({ x, words: '' });
    } else {
      first = { x, text, more: 0, behind: x - from < apart };
      out.push(first);
    }
  }
  return out.map(({ x, text, more, words, behind }) => ({ x, behind, words: words ?? `${text}${more ? `, ${more} more` : ''}` }));
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

/** A triangle of each slope, side by side, each under the curves there. least: where the lowest ends. */
function triangles(slopes, shown, { x, y }) {
  const nothing = { series: [], least: Infinity };
  if (!slopes?.length || !x.log || !y.log) return nothing;
  const [left, right] = extent(shown.flatMap((curve) => curve.points.map((p) => p[0])));
  const [bottom, top] = extent(shown.flatMap((curve) => curve.points.map((p) => p[1])));
  if (!(right > left)) return nothing;
  const wide = (right - left) / slopes.length;
  const corners = slopes.map((slope, i) => {
    const from = left + (i + 0.05) * wide, to = from + WIDE * wide;
    const low = lowest(shown, from, from + wide) - LABEL[1] * Math.max(top - bottom, 1) - slope * (to - from);
    return { slope, from, to, low, high: low + slope * (to - from) };
  });
  const series = corners.map(({ slope, from, to, low, high }) => ({ id: `slope ${slope}`, name: '', type: 'line', silent: true, showSymbol: false,
    data: [[to, (low + high) / 2], [to, high], [from, low], [to, low], [to, (low + high) / 2]], tooltip: { show: false }, lineStyle: { color: 'var(--soft)', width: 1 },
    endLabel: { ...TEXT, show: true, fontSize: 11, formatter: `slope ${slope}`, distance: 4 } }));
  return { series, least: Math.min(...corners.map(({ low }) => low)) };
}

/** Of the curves and the lines between their points, from one x to another. */
const lowest = (shown, from, to) => Math.min(...shown.flatMap(({ points }) => {
  const all = points.filter((p) => p[0] !== null && p[1] !== null);
  const first = all.findIndex((p) => p[0] >= from), behind = all.filter((p) => p[0] <= to).length;
  return all.slice(Math.max(0, first < 0 ? all.length - 1 : first - 1), behind + 1).map((p) => p[1]);
}));
