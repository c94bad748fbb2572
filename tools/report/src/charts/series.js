// The series of a block as ECharts takes them, on two axes that may be logarithmic or have a common offset taken away.

import { formatShort, prose } from '../format.js';
import { styleOf } from './palette.js';

const FEW = 48;       // so few points get markers
const ON_TOP = 2e-3;  // of the axis: closer curves cover each other

/** One axis: {label, log, to(value), from(coordinate)}: values are drawn at their logarithm, or less their common offset
 * where they are nearly constant; null is a gap. (An axis of ECharts that is itself logarithmic zooms in rounded values.) */
function readAxis(label, log, lists) {
  const offset = log ? 0 : commonOffset(lists);
  const sign = offset > 0 ? '−' : '+';
  return {
    label: `${label ?? ''}${offset === 0 ? '' : ` ${sign} ${formatShort(Math.abs(offset), 10)}`}`, log: Boolean(log), offset,
    to: (value) => (typeof value !== 'number' || (log && value <= 0) ? null : log ? Math.log10(value) : value - offset),
    from: (coordinate) => (log ? 10 ** coordinate : coordinate),
  };
}

function commonOffset(lists) {
  const [min, max] = extent(lists.flat());
  const [span, size] = [max - min, Math.max(Math.abs(min), Math.abs(max))];
  if (!(span > 0) || span > 1e-5 * size) return 0;
  const unit = 10 ** (Math.ceil(Math.log10(span)) + 1);
  return Number((Math.round((min + max) / 2 / unit) * unit).toPrecision(15));
}

export function extent(values) {
  return values.reduce(([a, b], v) => (Number.isFinite(v) ? [Math.min(a, v), Math.max(b, v)] : [a, b]), [Infinity, -Infinity]);
}

/** -> {x, y: axes, curves: [{name, style, points: [[x, y, member?], …], lows: the same of the lower edge of a band, envelope, dots, markers, alone: the numbers of points between gaps, tags, fit}], hidden}; `sorted` in order of x. */
export function readSeries(block, sorted) {
  if (!Array.isArray(block.series)) throw new Error('no list "series"');
  block.series.forEach((s, i) => {
    if (!Array.isArray(s?.x) || !Array.isArray(s?.y)) throw new Error(`series ${i + 1} (${s?.name}) needs the lists x and y`);
    if (s.x.length !== s.y.length) throw new Error(`series ${s.name}: x has ${s.x.length} values, y has ${s.y.length}`);
    if (s.members && s.members.length !== s.x.length) throw new Error(`series ${s.name}: x has ${s.x.length} values, members has ${s.members.length}`);
    if (s.low && s.low.length !== s.y.length) throw new Error(`series ${s.name}: y has ${s.y.length} values, low has ${s.low.length}`);
  });
  const x = readAxis(block.x, block.log_x, block.series.map((s) => s.x));
  const y = readAxis(block.y, block.log_y, block.series.flatMap((s) => [s.y, s.low ?? []]));
  let hidden = 0;
  const curves = block.series.map((s) => {
    const points = s.x.map((v, i) => (s.members ? [x.to(v), y.to(s.y[i]), s.members[i]] : [x.to(v), y.to(s.y[i])]));
    hidden += s.x.filter((v, i) => (x.log && v !== null && v <= 0) || (y.log && s.y[i] !== null && s.y[i] <= 0)).length;
    const isThere = (p) => p !== undefined && p[0] !== null && p[1] !== null;
    const few = points.filter(isThere).length <= FEW;  // as far as they can be drawn
    if (sorted && s.x.some((v, i) => i > 0 && v < s.x[i - 1])) points.sort((a, b) => a[0] - b[0]);
    return { name: prose(String(s.name ?? '')), style: styleOf(s), points, lows: s.low?.map((v, i) => [points[i][0], y.to(v)]) ?? [], envelope: Boolean(s.envelope), dots: Boolean(s.dots), markers: s.dots || (s.markers ?? (sorted && few)), tags: s.tags,
      alone: new Set(points.flatMap((p, i) => (isThere(p) && !isThere(points[i - 1]) && !isThere(points[i + 1]) ? [i] : []))),
      fit: s.fit ? String(s.fit.text || `slope ${s.fit.slope?.toFixed(2)}`) : '', picked: true, show: true };
  });
  return { x, y, curves, hidden };
}

/** Of the curves shown, the names of those that cover each other all along, each once; equal: the axes have one scale. */
export function covered({ curves }, equal) {
  const shown = curves.filter((curve) => curve.show && curve.points.length > 2);
  const size = [0, 1].map((axis) => extent(shown.flatMap((curve) => [...curve.points, ...curve.lows].map((p) => p[axis])))).map(([low, high]) => high - low);
  const near = ON_TOP * (equal ? Math.max(...size) : size[1]);
  const over = (v, w, most) => v === w || (v !== null && w !== null && Math.abs(v - w) <= most);
  const same = (a, b) => a.points.length === b.points.length && a.lows.length === b.lows.length &&
    a.lows.every(([, y], k) => over(y, b.lows[k][1], near)) && a.points.every(([x, y], k) => over(x, b.points[k][0], equal ? near : 0) && over(y, b.points[k][1], near));
  const groups = [];
  for (const curve of shown) {
    const group = groups.find(([first]) => same(first, curve));
    if (group) group.push(curve); else groups.push([curve]);
  }
  return groups.filter((group) => group.length > 1).map((group) => group.map(({ name }) => name));
}
