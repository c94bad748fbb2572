// A report with every kind of block and the awkward cases: 2000-point curves, 8 and 10 series, logarithms over
// 19 decades, zeros, NaN gaps, tiny and nearly constant ranges, hostile text.

import { ensemble } from './sample_members.mjs';
import { motion } from './sample_motion.mjs';
import { study } from './sample_study.mjs';

const range = (n, at) => Array.from({ length: n }, (_, i) => at(i));
const t = (n, end) => range(n, (i) => (i * end) / (n - 1));
let seed = 12345;
const random = () => { seed = (1103515245 * seed + 12345) % 2147483648; return seed / 2147483648; };

const names = ['lift s=0', 'lift s=½', 'lift s=1', 'balance', 'printed', 'unadapted', 'Runge–Kutta 4', 'implicit midpoint'];
const time = t(2000, 1800);

const energyErrors = names.map((name, k) => ({
  name, x: time, dashed: k === 5,
  y: time.map((at, i) => {
    if (k === 4 && i > 900 && i < 1000) return null;  // a gap
    if (k < 2 && i === 0) return 0;
    const size = 10 ** (-17 + 2.4 * k);
    return size * (1 + (k > 3 ? (at / 1800) * 30 : 0)) * (0.2 + Math.abs(Math.sin(at / (9 + 5 * k)))) * (0.5 + random());
  }),
}));

const steps = [0.1, 0.05, 0.025, 0.0125, 0.00625];
const orders = names.slice(1, 5).map((name, k) => ({
  name, x: steps, y: steps.map((h) => 0.3 * (k + 1) * h ** (k === 3 ? 4 : k === 0 ? 1 : 2)),
}));

const sleigh = (a, end) => {
  let [x, y, theta] = [0, 0, 0];
  const points = { x: [], y: [] };
  for (let i = 0; i < 2000; ++i) {
    const s = (i / 2000) * end;
    theta += 0.012 * Math.cos(s * a) * 2;
    x += 0.004 * Math.cos(theta) * Math.cos(s);
    y += 0.004 * Math.sin(theta) * Math.cos(s);
    points.x.push(x);
    points.y.push(i === 1200 ? null : y);
  }
  return points;
};

const onSphere = (k) => range(2000, (i) => {
  const s = i / 2000 * 12 * Math.PI;
  const polar = 0.5 + 0.55 * k + 0.35 * Math.sin(s * 0.31 + k);
  return [Math.sin(polar) * Math.cos(s * (0.4 + 0.1 * k)), Math.sin(polar) * Math.sin(s * (0.4 + 0.1 * k)), Math.cos(polar)];
});

const record = {
  system: 'suslov', group: 'so3', scheme: 'lift', s: 0.5, retraction: 'cayley', solver: 'newton', compose: 'none',
  step: 0.01, parameters: { inertia: [1, 10, 100], normal: [0, 0, 1] }, status: 'ok', reason: '', steps: 180000, time: 1800,
  final: { element: [[0.36, 0.48, -0.8], [-0.8, 0.6, 0], [0.48, 0.64, 0.6000000000000001]],
    velocity: [0.70710678118, -1.2e-17, 0], momentum: [1, 1, 0], energy: 0.55 },
  diagnostics: { constraint_max: 2.2e-16, holonomic_max: null, group_defect_max: 8.9e-16, energy_error_max: 3.1e-14, exact_error_final: 4.4e-6 },
  solver_stats: { iterations_mean: 2.01, iterations_max: 3, evaluations_mean: 3.01, residual_max: 8.7e-14 },
  timing: { seconds: 0.0512, nanoseconds_per_step: 284.4 }, version: '0.1.0', git: 'abc1234', host: 'laptop, 2 cores',
};

const plot = (title, x, y, series, more = {}) => ({ kind: 'plot', title, x, y, log_x: false, log_y: false, series, ...more });

export const sample = {
  title: 'Suslov problem: all readings side by side',
  subtitle: 'The paper’s experiment, J = diag(1, 10, 100), h = 0.01, 180 000 steps, with every reading of the printed scheme and the usual baselines.',
  generated: '2026-11-21T14:03:12.345Z', version: '0.1.0', git: 'abc1234', host: 'laptop, 2 cores',
  sections: [
    { title: 'Summary', blocks: [
      { kind: 'verdict', status: 'ok', text: 'The scheme `lift` with s = ½ keeps the constraint to **2.2·10⁻¹⁶** over 180 000 steps.' },
      { kind: 'verdict', status: 'failed', text: 'The reading `boxed_literal` diverges at t = 3.2 s: the solver did not converge (residual 4.1·10⁻²).' },
      { kind: 'verdict', status: 'note', text: 'All runs start from the momentum (1, 1, 0).' },
      { kind: 'text', paragraphs: [
        'The **Suslov problem** is a rigid body whose angular velocity along one body axis vanishes, `ω · n = 0`. Its energy is kept by the exact flow, and where the inertia is diagonal the solution is known in closed form, so that errors can be measured rather than estimated.',
        'Text is text: <b>no markup</b> & no <script>alert("x")</script>.'] },
      { kind: 'table', title: 'Drifts after 1800 s', columns: ['scheme', 'order', 'constraint', 'energy error', 'exact error', 'ns per step', 'status'],
        rows: names.map((name, k) => [name, k % 2 + 1, 2.2e-16 * 3 ** k, (k % 3 ? -1 : 1) * 1.234567e-14 * 40 ** k, k === 4 ? null : 3.21e-6 * 2 ** k, 284.4 + 1000.5 * k, k === 4 ? 'failed' : 'ok']),
        note: 'Largest value over the recorded states. A dash: nothing is known exactly.' },
      { kind: 'record', record },
    ] },
    { title: 'Energy', blocks: [
      plot('Energy error of eight schemes', 'time t [s]', '|energy error|', energyErrors, { log_y: true, note: 'The scheme `printed` was not recorded between 810 s and 900 s.' }),
      plot('Energy error, signed', 'time t [s]', 'energy error', [
        { name: 'lift s=½', x: time, y: time.map((at) => -3e-14 * Math.sin(at / 120) - 1e-14) },
        { name: 'balance', x: time, y: time.map((at) => 2e-14 * Math.cos(at / 90)) }]),
      plot('A nearly constant energy', 'time t [s]', 'energy [J]', [{ name: 'balance', x: time, y: time.map((at) => 0.55 + 4e-11 * Math.sin(at / 100)) }]),
      plot('Order of convergence', 'step h [s]', 'error at t = 1 s', orders, { log_x: true, log_y: true }),
    ] },
    { title: 'Motion', blocks: [
      { kind: 'path', title: 'Track of the contact point', x: 'x [m]', y: 'y [m]', series: [
        { name: 'lift s=½', ...sleigh(0.6, 12) }, { name: 'balance', ...sleigh(0.75, 12) }] },
      { kind: 'sphere', title: 'Motion of the body axes', series: [1, 2, 3].map((k) => ({ name: `e${k}`, points: onSphere(k) })), note: 'From t = 0 to 1800 s.' },
      plot('Ten series', 'time t [s]', 'ω₁ [rad/s]', range(10, (k) => ({ name: `run ${k + 1}, a rather long name`, x: t(400, 20), y: t(400, 20).map((at) => Math.sin(at * 0.5 + k * 0.3) * (1 + k / 5)) }))),
    ] },
    study,
    motion,
    ensemble,
    { title: 'Corner cases', blocks: [
      plot('Constant', 't [s]', 'value', [{ name: 'constant', x: [0, 1, 2], y: [1, 1, 1] }]),
      plot('Less than one decade', 'h', 'error', [{ name: 'lift s=1', x: t(50, 1), y: t(50, 1).map((v) => 3e-7 * (1 + v)) }], { log_y: true }),
      plot('Nothing to draw', 't [s]', '|error|', [{ name: 'zero', x: [0, 1, 2], y: [0, 0, -1] }], { log_y: true }),
      { kind: 'table', title: 'Mixed', columns: ['what', 'value', 'long text'], rows: [['a `name`', 1e300, 'x'.repeat(20)], ['b', -0.000123456, 'some words that go on and on until the line has to break somewhere'], ['c', null, ''], ['d', 123456.789, 'short'], ['e', 42, 'short']] },
    ] },
  ],
};
