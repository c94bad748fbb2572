// What a plot shows beside its curves: the floor of round-off, moments, bands, slopes.

import { TEXT } from './chart.js';
import { extent } from './series.js';

const [UNDER, OVER] = [3, 5];  // decades around the floor: the axis of a quantity that stays at round-off
const NEAR = 3;                // decades over the floor is still round-off

const line = (at, text, style = {}) => ({ ...at, symbol: 'none', lineStyle: { color: 'var(--soft)', type: [5, 4], width: 1, ...style },
  label: { ...TEXT, fontSize: 11, formatter: text, position: 'insideEndTop', show: Boolean(text) } });

/** The block -> {series, range: of the y axis, where it is fixed}. */
export function markings(block, shown, data) {
  const lines = (block.marks ?? []).map(({ x, text }) => line({ xAxis: x }, text));
  let range = null;
  if (block.floor > 0 && data.y.log) {
    const floor = Math.log10(block.floor);
    lines.push(line({ yAxis: floor }, 'round-off'));
    const [, most] = extent(shown.flatMap((curve) => curve.points.map((p) => p[1])));
    if (!(most > floor + NEAR)) {
      const low = Number.isFinite(most) ? Math.min(floor - UNDER, most - 1) : floor - UNDER;  // also what stays far under it is seen
      range = [Math.floor(low), Math.ceil(floor + OVER)];
    }
  }
  const bands = (block.bands ?? []).map(({ from, to, text }) => [{ xAxis: from, name: text }, { xAxis: to }]);
  const areas = bands.length ? [{ id: 'bands', name: '', type: 'line', data: [], silent: true, tooltip: { show: false }, markArea: { silent: true, data: bands,
    itemStyle: { color: 'var(--grid)', opacity: 0.6 }, label: { ...TEXT, fontSize: 11, position: 'insideTop' } } }] : [];
  const series = lines.length ? [{ id: 'marks', name: '', type: 'line', data: [], silent: true, tooltip: { show: false }, markLine: { silent: true, symbol: 'none', data: lines } }] : [];
  return { series: [...areas, ...series, ...triangles(block.slopes, shown, data)], range };
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
