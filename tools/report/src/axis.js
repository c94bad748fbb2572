// An axis turns values into the coordinate that is drawn (its logarithm, or what is left after a common offset
// is taken away), and says where ticks stand and what they read. uPlot only ever sees linear coordinates.

import { formatNumber, formatShort, formatTicks, power } from './format.js';

export class Axis {
  constructor(label, log, values) {
    this.log = Boolean(log);
    this.offset = this.log ? 0 : commonOffset(values);
    this.label = String(label ?? '');
    if (this.offset !== 0) {
      const sign = this.offset > 0 ? '−' : '+';
      this.label += ` ${sign} ${formatShort(Math.abs(this.offset), 10)}`;
    }
  }

  to(value) {
    if (typeof value !== 'number') return NaN;
    if (this.log) return value > 0 ? Math.log10(value) : NaN;
    return value - this.offset;
  }

  read(coordinate, digits) {
    return formatNumber(this.log ? 10 ** coordinate : coordinate, digits);
  }

  /** The range shown at first: [min, max] of the data with some air around. */
  home(min, max, air) {
    if (!(min <= max)) return this.log ? [-1, 1] : [0, 1];
    const span = max - min;
    if (span > 0) return [min - air * span, max + air * span];
    const half = this.log ? 0.5 : (Math.abs(min) || 1) * 0.1;
    return [min - half, max + half];
  }

  /** At most about `count` labelled ticks -> {at, labels}; a minor tick has the label ''. */
  ticks(min, max, count) {
    if (!this.log) return linearTicks(min, max, count);
    if (max - min < 0.35) return linearTicksOnLog(min, max, count);
    if (max - min < 1.6) return fractionTicks(min, max);
    return decadeTicks(min, max, count);
  }
}

function commonOffset(values) {
  let [min, max] = [Infinity, -Infinity];
  for (const list of values) {
    for (const value of list) {
      if (!Number.isFinite(value)) continue;
      if (value < min) min = value;
      if (value > max) max = value;
    }
  }
  const span = max - min;
  const size = Math.max(Math.abs(min), Math.abs(max));
  if (!(span > 0) || span > 1e-5 * size) return 0;
  const unit = 10 ** (Math.ceil(Math.log10(span)) + 1);
  return Number((Math.round((min + max) / 2 / unit) * unit).toPrecision(15));
}

function niceStep(span, count) {
  const raw = span / Math.max(1, count);
  const magnitude = 10 ** Math.floor(Math.log10(raw));
  return [1, 2, 5, 10].find((factor) => factor * magnitude >= raw * 0.999) * magnitude;
}

function multiples(min, max, step) {
  const first = Math.ceil(min / step - 1e-9);
  const last = Math.floor(max / step + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, i) => (first + i) * step);
}

function linearTicks(min, max, count) {
  let step = niceStep(max - min, count);
  if (multiples(min, max, step).length < 3) step = niceStep(max - min, 2 * count);
  const at = multiples(min, max, step);
  return { at, labels: formatTicks(at, step) };
}

function linearTicksOnLog(min, max, count) {
  const { at, labels } = linearTicks(10 ** min, 10 ** max, count);
  return { at: at.map(Math.log10), labels };
}

function fractionTicks(min, max) {
  const [at, labels] = [[], []];
  for (let n = Math.floor(min); n <= Math.ceil(max); ++n) {
    for (let factor = 1; factor < 10; ++factor) {
      const place = n + Math.log10(factor);
      if (place < min || place > max) continue;
      at.push(place);
      const label = factor === 1 ? power(n) : `${factor}·${power(n)}`;
      labels.push([1, 2, 5].includes(factor) ? label : '');
    }
  }
  return { at, labels };
}

function decadeTicks(min, max, count) {
  const decades = max - min;
  const step = [1, 2, 3, 5, 10, 20, 50, 100].find((s) => decades / s <= count + 0.5) ?? 200;
  const [at, labels] = [[], []];
  for (const n of multiples(min, max, step)) {
    at.push(n);
    labels.push(power(n));
  }
  if (step > 1) {
    for (const n of multiples(min, max, 1)) {
      if (n % step === 0) continue;
      at.push(n);
      labels.push('');
    }
  }
  return { at, labels };
}
