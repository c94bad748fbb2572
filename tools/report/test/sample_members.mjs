// The blocks of an ensemble: a map of classes, dots and curves of members, a scatter matrix, the members themselves.

import { body } from './sample_motion.mjs';

const range = (n, at) => Array.from({ length: n }, (_, i) => at(i));
const [rows, columns] = [5, 8];
const count = rows * columns;
const classes = ['turns left', 'turns right', 'falls'];
const spin = range(count, (k) => -1 + 2 * Math.floor(k / columns) / (rows - 1));
const speed = range(count, (k) => 0.5 + (k % columns) / 4);
const kind = range(count, (k) => (spin[k] < -0.2 ? 1 : speed[k] > 1.8 ? 2 : 0));
const kept = (f) => range(count, (k) => (k === 11 ? null : f(spin[k], speed[k], k)));
const angle = kept((w, v) => w * v + 0.1 * Math.sin(9 * w));
const reach = kept((w, v) => v * v);
const drift = kept((w, v, k) => 1e-7 * (1 + ((k * 7) % 5)));

const grid = (list) => range(rows, (r) => list.slice(r * columns, (r + 1) * columns));

export const classMap = {
  kind: 'heatmap', title: 'class', x: 'speed [m/s]', y: 'spin [rad/s]', x_values: speed.slice(0, columns), y_values: range(rows, (r) => spin[r * columns]),
  values: grid(range(count, (k) => (k === 11 ? null : kind[k]))), marks: grid(range(count, (k) => (k === 11 ? 'failed' : ''))), members: grid(range(count, (k) => k)), classes,
};

/** So many columns that it takes the whole width of the page. */
export const wideMap = {
  kind: 'heatmap', title: 'angle', x: 'number', y: 'half', x_values: range(count / 2, (c) => c), y_values: [0, 1], unit: 'rad',
  values: range(2, (r) => range(count / 2, (c) => angle[(r * count) / 2 + c])), members: range(2, (r) => range(count / 2, (c) => (r * count) / 2 + c)),
};

export const memberDots = {
  kind: 'plot', title: 'angle over speed', x: 'speed [m/s]', y: 'angle [rad]',
  series: classes.map((name, c) => {
    const of = range(count, (k) => k).filter((k) => kind[k] === c && k !== 11);
    return { name, dots: true, x: of.map((k) => speed[k]), y: of.map((k) => angle[k]), members: of };
  }),
};

const correlation = (a) => [angle, reach, drift].map((b) => (a === b ? 1 : -0.31));
export const matrix = {
  kind: 'scatter', title: 'Scatter matrix of what is kept', classes, class: kind, members: range(count, (k) => k),
  columns: [['angle', 'rad', angle], ['largest distance from the start', 'm', reach], ['energy_error', '', drift]].map(([name, unit, values]) => ({ name, unit, values, correlation: correlation(values) })),
  note: 'Member 11 has no values.',
};

export const members = {
  kind: 'members', command: 'hamel ensemble sample.toml --member {} -o FOLDER', count, failures: { 11: 'the step did not converge' },
  paragraphs: ['A click on a member shows its values.'],
  columns: [{ name: 'spin', unit: 'rad/s', varied: true, values: spin }, { name: 'speed', unit: 'm/s', varied: true, values: speed },
    { name: 'angle', unit: 'rad', values: angle }, { name: 'class', values: range(count, (k) => (k === 11 ? null : kind[k])), names: classes }],
  motions: { 3: [{ ...body(), title: 'Member 3' }] },
};

/** More dots than one draws one by one. */
export const crowd = (n) => ({
  ...matrix, classes: undefined, class: undefined, members: range(n, (k) => 25 * k),
  columns: ['a', 'b', 'c', 'd', 'e'].map((name, c) => ({ name, values: range(n, (k) => Math.sin((c + 1.3) * k) + c * Math.cos(0.7 * k)) })),
});

export const ensemble = { title: 'Ensemble', blocks: [members, classMap, memberDots, matrix] };
