// The blocks of a study: heat maps, many series with filters and fitted orders, a long table with filters.

const systems = ['suslov', 'chaplygin_sleigh', 'rolling_disk', 'veselova', 'ball_on_turntable'];
const schemes = ['lift', 'balance', 'boxed', 'unadapted', 'energy_preserving', 'reversible', 'gni', 'rkmk4'];
const range = (n, at) => Array.from({ length: n }, (_, i) => at(i));
const error = (a, b) => 10 ** (-15 + 13 * Math.abs(Math.sin(3.7 * a + 1.3 * b * b + 0.2)));

export const errorMap = {
  kind: 'heatmap', title: 'Energy error by scheme and system', x: 'system', y: 'scheme', x_values: systems, y_values: schemes,
  values: schemes.map((_, i) => systems.map((__, k) => ((i * 5 + k) % 11 === 3 ? null : error(i, k)))),
  marks: schemes.map((_, i) => systems.map((__, k) => ((i * 5 + k) % 11 === 3 ? ['failed', 'not offered'][i % 2] : i === 1 && k < 2 ? 'stopped' : ''))),
  log: true, unit: 'relative energy error', note: 'A hatched cell was not run to its end.',
};

const orderMap = {
  kind: 'heatmap', title: 'Stability over step and inclination', x: 'step h [s]', y: 'inclination [rad]', log: false, unit: 'growth [1/s]',
  x_values: range(40, (i) => +(0.01 + 0.005 * i).toFixed(4)), y_values: range(30, (k) => +(-0.7 + 0.05 * k).toFixed(3)),
  values: range(30, (k) => range(40, (i) => ((i - 30) ** 2 + (k - 22) ** 2 < 20 ? null : Math.sin(i / 9) * Math.cos(k / 7) - 0.2))),
};

export const tallMap = {
  kind: 'heatmap', title: 'Reversals over spin and skew', x: 'skew [rad]', y: 'start.omega3 [rad/s]',
  x_values: range(40, (i) => 0.05 + 0.0141 * i), y_values: range(40, (k) => -3 + 0.0641 * k),
  values: range(40, (k) => range(40, (i) => (i * k) % 4)),
};

const zeros = {
  kind: 'heatmap', title: 'Zeros on a logarithmic scale', x: 's', y: 'retraction', log: true, unit: 'drift',
  x_values: [0, 0.5, 1], y_values: ['cayley', 'exp'], values: [[0, 1e-15, 3e-13], [2e-16, 0, 5e-12]], marks: [['exact', '', ''], ['', 'exact', '']],
};

const constant = {
  kind: 'heatmap', title: 'One value', x: 'scheme', y: 'system', x_values: schemes.concat(['a_name_that_is_rather_long_for_a_cell']), y_values: ['suslov'],
  values: [range(9, () => 2)],
};

const steps = [0.1, 0.05, 0.025, 0.0125, 0.00625];
export const convergence = {
  kind: 'plot', title: 'Order of convergence, 40 curves', x: 'step h [s]', y: 'error at t = 1 s', log_x: true, log_y: true, slopes: [1, 2, 4],
  filters: [{ name: 'system', values: systems }, { name: 'kind', values: ['ours', 'baseline'] }],
  series: systems.flatMap((system, k) => schemes.map((name, i) => {
    const order = i === 7 ? 4 : i === 2 ? 1 : 2;
    return { name, x: steps, y: steps.map((h) => 0.1 * (1 + k) * (1 + 0.7 * i) * h ** order), tags: { system, kind: i < 4 ? 'ours' : 'baseline' },
      fit: { slope: order + 0.004 * k, text: i % 2 ? '' : `order ${(order + 0.004 * k).toFixed(2)} of 5 steps` } };
  })),
};

const marked = {
  kind: 'plot', title: 'Markers asked for', x: 't [s]', y: 'x [m]',
  series: [{ name: 'marked', markers: true, x: range(80, (i) => i / 8), y: range(80, (i) => Math.cos(i / 8)) }],
};

/** n rows of `columns` columns: names, few choices, numbers, statuses. */
export const longTable = (n, columns) => ({
  kind: 'table', filter: true, title: `${n} runs`,
  columns: ['run', 'system', 'scheme', 'step', 'status', 'note', ...range(columns - 6, (c) => `figure ${c + 1}`)],
  rows: range(n, (i) => [i + 1, systems[i % 5], schemes[(i * 7) % 8], 0.1 / 2 ** (i % 6), i % 17 === 4 ? 'failed' : 'ok',
    i % 3 ? null : `seed ${i * 31}`, ...range(columns - 6, (c) => 1e-3 * Math.sin(i + c) ** 2)]),
  note: 'Made up.',
});

export const study = { title: 'Study', blocks: [errorMap, orderMap, tallMap, zeros, constant, convergence, marked, longTable(400, 9)] };
