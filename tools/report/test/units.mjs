// What can be checked without a browser: [what, whether it is so].

import { luminance, sequential } from '../src/charts/colours.js';
import { logTicks, niceTicks, prose } from '../src/format.js';
import { spreadNames } from '../src/stage/labels.js';
import { floorGrid, middleOf, placed, placeInTime, poseAt, readMotion, slerp, turnFromZ, turned } from '../src/stage/motion.js';
import { columnsToCsv } from '../src/save.js';
import { covered, readSeries } from '../src/charts/series.js';
import { stateOf } from '../src/state.js';

const near = (a, b) => a.length === b.length && a.every((v, i) => Math.abs(v - b[i]) < 1e-12);
const about = (axis, angle) => [Math.cos(angle / 2), ...axis.map((v) => v * Math.sin(angle / 2))];
const X = [1, 0, 0];
const Z = [0, 0, 1];
const axis = [2, -1, 2].map((v) => v / 3);
const [from, to] = [about(axis, 0.3), about(axis, 1.7)];
const lights = Array.from({ length: 101 }, (_, i) => luminance(sequential(i / 100)));
const quarter = about(Z, Math.PI / 2);
const motion = readMotion({ times: [0, 1, 3], bodies: [{ name: 'b', trail: true, trail_point: [1, 0, 0], shapes: [{ shape: 'sphere', radius: 1 }],
  poses: [[0, 0, 0, 1, 0, 0, 0], [2, 0, 0, 2 * quarter[0], 0, 0, 2 * quarter[3]], [null, 0, 0, 1, 0, 0, 0]] }] });
const aside = readMotion({ times: [0], bodies: [{ name: 'b', shapes: [{ shape: 'sphere', radius: 1, at: [5, 0, 0] }], poses: [[-1, 0, 0, 1, 0, 0, 0]] }] });
const at = (t) => poseAt(motion.bodies[0], placeInTime(motion.times, t));
const grid = floorGrid([[0, 0, 0], [10, 3, 1]]);

const x = [0, 1, 2, 3];
const over = (a, b, more = {}) => covered(readSeries({ series: [{ name: 'a', x, y: a }, { name: 'b', x, y: b, ...more }] }, true)).length;
const pathsOver = (shift) => covered(readSeries({ series: [0, shift].map((d) => ({ name: `${d}`, x: x.map((v) => v + d), y: x.map((v) => d * v) })) }, false), true).length;
const four = covered(readSeries({ series: [[0, 1, 0, 1], [5, 5, 5, 4], [0, 1, 0, 1], [0, 1, 0, 1]].map((y, i) => ({ name: `w${i + 1}`, x, y })) }, true));
const ball = (radius, y) => ({ name: `${radius}`, shapes: [{ shape: 'sphere', radius, at: [1, 0, 0] }], poses: [[-1, y, 0, 1, 0, 0, 0]] });
const shells = (y) => readMotion({ times: [0], bodies: [ball(2, 0), ball(0.5, y)] }).bodies.map(({ shapes: [shape] }) => shape.shell).join();
const ticks = niceTicks(-0.31, 0.42, 5);
const spans = [0.02, 0.1, 0.3, 0.399, 0.401, 0.5, 0.7, 0.9, 1, 1.3, 1.99, 2.01, 3, 7, 14];  // decades, each from many places
const counts = spans.flatMap((span) => Array.from({ length: 100 }, (_, i) => logTicks(-4 + i / 100, -4 + i / 100 + span, 5).at.length));

const verdicts = (...all) => [{ blocks: all.map((status) => ({ kind: 'verdict', status })) }];
const state = (...all) => stateOf(verdicts(...all))?.text;
const ran = (status) => ({ blocks: [{ kind: 'record', record: { status } }] });

// Names that come near one another at all heights: round-off must not move one for ever.
const crowds = Array.from({ length: 20000 }, (_, i) => Array.from({ length: 4 }, (__, k) => ({ across: (i * 7.31 + k * 11.7) % 60, down: (i * 0.377 + k * 5.11) % 200 + 1 / 3, half: 20 })));
const apart = (names) => spreadNames(names).every((down, i, all) => down === null || all.every((other, k) => k === i || other === null ||
  Math.abs(other - down) > 12.9 || Math.abs(names[i].across - names[k].across) >= 43));

export const units = [
  ['the colour scale gets darker throughout', lights.every((light, i) => i === 0 || light < lights[i - 1])],
  ['a quarter turn about z takes x to y', near(turned(quarter, X), [0, 1, 0])],
  ['a turn keeps its axis and lengths', near(turned(from, axis), axis) && Math.abs(Math.hypot(...turned(from, [3, 4, 12])) - 13) < 1e-12],
  ['slerp goes evenly about the common axis', [0, 0.25, 0.5, 1].every((u) => near(slerp(from, to, u), about(axis, 0.3 + 1.4 * u)))],
  ['slerp takes the shorter arc', near(slerp(from, to.map((v) => -v), 0.5), about(axis, 1))],
  ['slerp of nearly equal turns', near(slerp(from, about(axis, 0.3 + 1e-9), 0.5), about(axis, 0.3 + 5e-10))],
  ['z is taken to any axis', [[1, 0, 0], [0, 0, -2], [1, -2, 3], [0, 0, 1]].every((v) =>
    near(turned(turnFromZ(v), Z), v.map((c) => c / Math.hypot(...v))))],
  ['poses at the nodes', near(at(0).at, [0, 0, 0]) && near(at(1).turn, quarter)],
  ['half way between two poses', near(at(0.5).at, [1, 0, 0]) && near(at(0.5).turn, about(Z, Math.PI / 4))],
  ['a point of the body in space', near(placed(at(1), X), [2, 1, 0]) && near(motion.bodies[0].way[1], [2, 1, 0])],
  ['beyond the last good pose there is none', at(2) === null && at(3) === null && motion.missing === 1],
  ['bodies are followed about their middles, not their frames', near(middleOf(aside.bodies, [poseAt(aside.bodies[0], placeInTime([0], 0))]), [4, 0, 0]) && aside.reach < 1.01],
  ['paths that cover each other up to round-off', pathsOver(1e-15) === 1 && pathsOver(0.1) === 0],
  ['the room that a motion takes', near(motion.box[0], [-1, -1, -1]) && near(motion.box[1], [3, 1, 1])],
  ['names do not cover one another', crowds.every(apart) && crowds.some((names) => spreadNames(names).includes(null))],
  ['the floor reaches under all of it', Math.max(...grid.lines.flat().map((p) => p[0])) >= 10 && grid.lines.length < 40],
  ['curves that cover each other are found', over([0, 1, 0, 1], [0, 1.001, 0, 1]) === 1 && over([0, 1, 0, 1], [0, 1, 0, 0.9]) === 0],
  ['one way to write numbers', prose('at most **1.8e-13**, 0.0e+00, rtol = 1e-08, 2e+05 of 981e-4ab, x1e-3') === 'at most **1.8·10⁻¹³**, 0, rtol = 10⁻⁸, 2·10⁵ of 981e-4ab, x1e-3'],
  ['of curves that coincide each is named once', four.map((names) => names.join()).join(';') === 'w1,w3,w4'],
  ['a ball that holds another body is a shell', shells(1.4) === 'true,false' && shells(1.7) === 'false,false'],
  ['a band and a curve do not coincide', over([0, 1, 0, 1], [0, 1, 0, 1], { low: [-1, -1, -1, -1] }) === 0],
  ['only the band of a curve of many turns is called one', [true, undefined].every((envelope) =>
    readSeries({ series: [{ name: 'a', x, y: [1, 1, 1, 1], low: [0, 0, 0, 0], envelope }] }, true).curves[0].envelope === Boolean(envelope))],
  ['a logarithm leaves out what is not above zero', readSeries({ log_y: true, series: [{ name: 'a', x, y: [1, 0, -1, null] }] }, true).hidden === 2],
  ['ticks at round numbers with equal decimals', near(ticks.at, [-0.2, 0, 0.2, 0.4]) && ticks.read(0) === '0.0' && ticks.read(-0.2) === '−0.2'],
  ['an axis of logarithms has ticks, however far it is zoomed', Math.min(...counts) >= 3 && Math.max(...counts) <= 12],
  ['verdicts are counted', state('ok') === '✓ OK' && state('ok', 'ok') === '✓ all 2 verdicts OK' && state('ok', 'failed') === '✕ 1 of 2 failed'],
  ['a note is never counted as OK', state('note') === undefined && state('ok', 'note') === '✓ 1 verdict OK, 1 note'],
  ['a run that came to its end is not called OK', stateOf([ran('ok')]) === null && stateOf([...verdicts('note'), ran('ok')]) === null],
  ['a run that failed is told without verdicts', stateOf([ran('ok'), ran('failed')]).text === '✕ 1 of 2 failed' && stateOf([ran('ok'), ran('failed')]).failed[0] === 2],
  ['a saved table', columnsToCsv([{ name: 't', values: [0, 1] }, { name: 'a "b"', values: [2] }]) === '"t","a ""b"""\n0,2\n1,\n'],
];
