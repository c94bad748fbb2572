// Series of a figure as coordinates: Float64Arrays in which NaN is a gap.

import { Axis } from './axis.js';
import { styleOf } from './palette.js';

const FEW = 48;  // so few points get markers

/** The data's series on two axes -> {x, y: Axis, curves, hidden}; `sorted` puts each in order of x. */
export function readCurves(block, { sorted, logX = false, logY = false }) {
  if (!Array.isArray(block.series)) throw new Error('no list "series"');
  const lists = block.series.map((series, i) => {
    if (!Array.isArray(series?.x) || !Array.isArray(series?.y)) {
      throw new Error(`series ${i + 1} (${series?.name}) needs the lists x and y`);
    }
    if (series.x.length !== series.y.length) {
      throw new Error(`series ${series.name}: x has ${series.x.length} values, y has ${series.y.length}`);
    }
    return series;
  });
  const x = new Axis(block.x, logX, lists.map((s) => s.x));
  const y = new Axis(block.y, logY, lists.map((s) => s.y));
  let hidden = 0;
  const curves = lists.map((series) => {
    const n = series.x.length;
    const order = sorted ? orderOf(series.x) : null;
    const curve = {
      name: String(series.name ?? ''), style: styleOf(series), show: true, picked: true, n,
      x: new Float64Array(n), y: new Float64Array(n), markers: series.markers === true || (sorted && n <= FEW),
      tags: series.tags, fit: readFit(series.fit),
    };
    for (let i = 0; i < n; ++i) {
      const from = order ? order[i] : i;
      curve.x[i] = x.to(series.x[from]);
      curve.y[i] = y.to(series.y[from]);
      if ((logX && series.x[from] <= 0 && series.x[from] !== null) ||
          (logY && series.y[from] <= 0 && series.y[from] !== null)) ++hidden;
    }
    return curve;
  });
  return { x, y, curves, hidden };
}

/** What the legend says of a fitted line; its slope where the data has no words for it. */
function readFit(fit) {
  if (!fit) return '';
  return String(fit.text || (typeof fit.slope === 'number' ? `slope ${fit.slope.toFixed(2)}` : ''));
}

function orderOf(x) {
  let rising = true;
  for (let i = 1; i < x.length && rising; ++i) rising = x[i] >= x[i - 1];
  if (rising) return null;
  return x.map((_, i) => i).filter((i) => Number.isFinite(x[i])).sort((a, b) => x[a] - x[b])
    .concat(x.map((_, i) => i).filter((i) => !Number.isFinite(x[i])));
}

/** [min, max] of both coordinates over the curves that are shown. */
export function bounds(curves) {
  const box = { x: [Infinity, -Infinity], y: [Infinity, -Infinity] };
  for (const curve of curves) {
    if (!curve.show) continue;
    for (let i = 0; i < curve.n; ++i) {
      const [x, y] = [curve.x[i], curve.y[i]];
      if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
      if (x < box.x[0]) box.x[0] = x;
      if (x > box.x[1]) box.x[1] = x;
      if (y < box.y[0]) box.y[0] = y;
      if (y > box.y[1]) box.y[1] = y;
    }
  }
  return box;
}

/** The point of a curve, sorted in x, nearest to x; null beyond its ends (by `reach`) and in gaps. */
export function nearestInX(curve, x, reach) {
  let [low, high] = [0, curve.n - 1];
  while (high >= 0 && Number.isNaN(curve.x[high])) --high;
  if (high < 0 || x < curve.x[0] - reach || x > curve.x[high] + reach) return null;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (curve.x[middle] <= x) low = middle; else high = middle;
  }
  const nearest = x - curve.x[low] <= curve.x[high] - x ? low : high;
  return Number.isFinite(curve.y[nearest]) ? nearest : null;
}

/** The point of any curve nearest to (x, y), distances divided by the scales; null further than 1. */
export function nearestInPlane(curve, x, y, scaleX, scaleY) {
  let [best, least] = [null, 1];
  for (let i = 0; i < curve.n; ++i) {
    const distance = ((curve.x[i] - x) / scaleX) ** 2 + ((curve.y[i] - y) / scaleY) ** 2;
    if (distance < least) [best, least] = [i, distance];
  }
  return best;
}

/**
 * Draws a curve: (x, y) -> pixels by the two functions. What falls in one pixel column is drawn as its first,
 * lowest, highest and last point, so that long series stay quick and look the same.
 */
export function trace(curve, toX, toY, radius) {
  const line = new Path2D();
  const dots = curve.markers ? new Path2D() : null;
  let down = false;
  let column = null;  // {x, first, low, high, last} waiting to be drawn
  const flush = () => {
    if (!column) return;
    const { x, first, low, high, last } = column;
    if (!down) line.moveTo(x, first); else line.lineTo(x, first);
    if (low !== high) {
      line.lineTo(x, low);
      line.lineTo(x, high);
      line.lineTo(x, last);
    } else if (!down) {
      line.lineTo(x, first);  // a lone point shows as a dot (round caps)
    }
    down = true;
    column = null;
  };
  for (let i = 0; i < curve.n; ++i) {
    const x = toX(curve.x[i]);
    const y = toY(curve.y[i]);
    if (!Number.isFinite(x) || !Number.isFinite(y)) {
      flush();
      down = false;
      continue;
    }
    if (dots) {
      dots.moveTo(x + radius, y);
      dots.arc(x, y, radius, 0, 2 * Math.PI);
    }
    if (column && Math.abs(x - column.x) < 0.5) {
      column.low = Math.min(column.low, y);
      column.high = Math.max(column.high, y);
      column.last = y;
    } else {
      flush();
      column = { x, first: y, low: y, high: y, last: y };
    }
  }
  flush();
  return { line, dots };
}
