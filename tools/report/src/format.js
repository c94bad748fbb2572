// Numbers as people read them: 1.23·10⁻⁷, a true minus sign, a dash for what is missing.

const SUPERSCRIPTS = { '-': '⁻', 0: '⁰', 1: '¹', 2: '²', 3: '³', 4: '⁴', 5: '⁵', 6: '⁶', 7: '⁷', 8: '⁸', 9: '⁹' };
export const MISSING = '–';

const minus = (text) => text.replace('-', '−');

/** 10ⁿ for an integer n. */
export function power(n) {
  return '10' + [...String(n)].map((digit) => SUPERSCRIPTS[digit]).join('');
}

/** A text in which numbers are written as everywhere on the page: 1.8e-13 is 1.8·10⁻¹³, 1e-08 is 10⁻⁸. (A sign behind the e: no name is meant.) */
export const prose = (text) => text.replace(/(?<![\w.])(\d+(?:\.\d+)?)e([+-]\d+)(?!\w)/g,
  (_, mantissa, exponent) => (+mantissa === 0 ? '0' : mantissa === '1' ? power(+exponent) : `${mantissa}·${power(+exponent)}`));

/** The same without zeros at the end of the decimals: for parameters, which were typed by a person. */
export function formatShort(value, digits = 6) {
  return formatNumber(value, digits).replace(/(\.\d*?)0+(?=·|$)/, '$1').replace(/\.(?=·|$)/, '');
}

/** Plain decimals between 0.001 and 99999, m·10ⁿ elsewhere; `digits` significant digits. */
export function formatNumber(value, digits = 4) {
  if (typeof value !== 'number' || Number.isNaN(value)) return MISSING;
  if (!Number.isFinite(value)) return value > 0 ? '∞' : '−∞';
  if (value === 0) return '0';
  if (Number.isInteger(value) && Math.abs(value) < 1e6) return minus(String(value));
  const place = +value.toExponential(digits - 1).split('e')[1];
  if (place >= -3 && place < 5) return minus(value.toFixed(Math.max(0, digits - 1 - place)));
  const [mantissa, exponent] = value.toExponential(digits > 4 ? digits - 1 : 2).split('e');
  return minus(mantissa) + '·' + power(+exponent);
}

/** Tick labels that share one style and number of decimals; `step` is their spacing. */
export function formatTicks(values, step) {
  const largest = Math.max(...values.map(Math.abs));
  const stepExponent = Math.floor(Math.log10(step) + 1e-9);
  if (largest === 0) return values.map(() => '0');
  if (largest >= 9.99e-4 && largest < 1e5) {
    return values.map((value) => minus((value || 0).toFixed(Math.max(0, -stepExponent))));
  }
  const exponent = Math.floor(Math.log10(largest) + 1e-9);
  const decimals = Math.max(0, exponent - stepExponent);
  return values.map((value) => {
    if (value === 0) return '0';
    return minus((value / 10 ** exponent).toFixed(decimals)) + '·' + power(exponent);
  });
}

/** Any JSON value in a table cell or a record; `number` formats the numbers in it. */
export function formatValue(value, number = formatNumber) {
  if (value === null || value === undefined) return MISSING;
  if (typeof value === 'number') return number(value);
  if (typeof value === 'boolean') return value ? 'yes' : 'no';
  if (Array.isArray(value)) return formatList(value, number);
  if (typeof value === 'object') return JSON.stringify(value);
  return prose(String(value));
}

function formatList(list, number) {
  const size = list.flat(Infinity).length;
  if (size > 40) return `(${size} values)`;
  if (list.some((item) => Array.isArray(item))) return list.map((item) => formatValue(item, number)).join('\n');
  return '(' + list.map((item) => formatValue(item, number)).join(', ') + ')';
}

/** Ticks at multiples of 1, 2 or 5 times a power of ten, about `count` of them -> {at, read(value)}. */
export function niceTicks(min, max, count) {
  const raw = (max - min) / Math.max(2, count);
  const magnitude = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find((factor) => factor * magnitude >= raw * 0.999) * magnitude;
  const [first, last] = [Math.ceil(min / step - 1e-9), Math.floor(max / step + 1e-9)];
  const at = Array.from({ length: Math.max(0, last - first + 1) }, (_, i) => +((first + i) * step).toPrecision(12));
  const labels = at.length ? formatTicks(at, step) : [];
  return { at, read: (value) => labels[at.findIndex((v) => Math.abs(v - value) < 1e-6 * step)] ?? '' };
}

const FEWEST = 3;  // ticks from which a reader sees a scale

/** Ticks of an axis of logarithms, about `count`: powers of ten; where these are few, 1, 2 and 5 times them; where these are few, even steps. */
export function logTicks(min, max, count) {
  const step = Math.max(1, Math.ceil((max - min) / count));
  const decades = Array.from({ length: Math.ceil(max) - Math.floor(min) + 1 }, (_, i) => Math.floor(min) + i);
  const inside = (list) => list.filter((v) => v >= min - 1e-9 && v <= max + 1e-9);
  const powers = inside(decades.filter((n) => n % step === 0));
  const at = powers.length >= FEWEST ? powers : inside(decades.flatMap((n) => [1, 2, 5].map((factor) => n + Math.log10(factor))));
  if (at.length >= FEWEST) return { at, read: (coordinate) => powerLabel(10 ** coordinate) };
  let even = niceTicks(10 ** min, 10 ** max, count);
  for (let more = count; even.at.length < FEWEST; ) even = niceTicks(10 ** min, 10 ** max, ++more);
  return { at: even.at.map(Math.log10), read: (coordinate) => even.read(10 ** coordinate) };
}

/** 10⁻⁷, 2·10⁻⁷. */
function powerLabel(value) {
  const n = Math.floor(Math.log10(value) + 1e-9);
  const factor = Math.round(value / 10 ** n);
  return `${factor === 1 ? '' : `${factor}·`}${power(n)}`;
}

const [TYPED, MOST_DECIMALS] = [6, 6];  // a number of so few digits was typed by a person

/** The one notation of a column of numbers: whole, with equal decimals, or m.mm·10ⁿ -> a function from number to text. */
export function columnFormat(values) {
  const numbers = values.filter((v) => typeof v === 'number' && Number.isFinite(v));
  const sizes = numbers.filter((v) => v !== 0).map(Math.abs);
  const [least, most] = [Math.min(...sizes), Math.max(...sizes)];
  const shown = (write) => (v) => (typeof v !== 'number' || !Number.isFinite(v) ? formatNumber(v) : minus(write(v)));
  if (sizes.length === 0 || (numbers.every(Number.isInteger) && most < 1e9)) return shown(String);
  const places = (v) => (String(v).includes('e') ? Infinity : (String(v).split('.')[1] ?? '').length);
  const digits = (v) => String(v).replace(/^0\.0*|\./g, '').length;
  const typed = numbers.every((v) => digits(v) <= TYPED) ? Math.max(...numbers.map(places)) : Infinity;
  if (typed <= MOST_DECIMALS) return shown((v) => v.toFixed(typed));
  if (least >= 1e-3 && most < 1e5 && most / least < 1e3) {
    const decimals = Math.max(0, Math.min(MOST_DECIMALS, 2 - Math.floor(Math.log10(least))));
    return shown((v) => v.toFixed(decimals));
  }
  return shown((v) => {
    if (v === 0) return '0';
    const [mantissa, exponent] = v.toExponential(2).split('e');
    return `${mantissa}·${power(+exponent)}`;
  });
}
