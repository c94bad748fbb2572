// node test/check.mjs [BUILT.html [WORD]]: the sample page passes render.mjs, and pages with a planted fault do not; WORD: only the cases
// with it in their name.

import { spawn, spawnSync } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { serve } from './browser.mjs';
import { fill } from './fill.mjs';
import { sample } from './sample_data.mjs';
import { classMap, crowd, matrix, memberDots, members, wideMap } from './sample_members.mjs';
import { body } from './sample_motion.mjs';
import { convergence, errorMap, longTable, tallMap } from './sample_study.mjs';
import { units } from './units.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const folder = mkdtempSync(join(tmpdir(), 'hamel-report-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));

let built = process.argv[2];
if (!built) {
  built = join(folder, 'built.html');
  const build = spawnSync(process.execPath, [join(here, '../build.mjs'), built], { stdio: 'inherit' });
  if (build.status !== 0) process.exit(1);
}
const page = readFileSync(built, 'utf8');
const good = fill(page, JSON.stringify(sample));
const small = (...blocks) => fill(page, JSON.stringify({ title: 'Fault', sections: [{ title: 'One', blocks }] }));
const text = { kind: 'text', paragraphs: ['A text.'] };
const note = { kind: 'verdict', status: 'note', text: 'A note.' };
const series = [{ name: 'a', x: [0, 1, 2], y: [0, 1, 0] }];
const plot = { kind: 'plot', title: 'A plot', x: 'x', y: 'y', series };
const tinyPath = { kind: 'path', title: 'A turn in place', x: 'x [m]', y: 'y [m]', series: [{ name: 'a', x: [0, 3e-18, -8.7e-18, 1.5e-17], y: [0, 1.2e-17, -3.6e-17, -1.2e-17] }] };
const unmarked = { ...errorMap, marks: undefined };
const strikes = { ...plot, series: [{ name: 'a', x: Array.from({ length: 61 }, (_, i) => i / 30), y: Array.from({ length: 61 }, (_, i) => (i % 7) / 7) }], marks: [0.002, 0.1, 0.2, 0.9, 1.3, 1.31, 1.34, 1.37, 1.375, 1.38, 1.9].map((at, i) => ({ x: at, text: `corner ${i % 4}.strikes` })) };
const sparse = (apart) => ({ ...plot, log_y: true, series: [{ name: 'a', x: Array.from({ length: 200 }, (_, i) => i), y: Array.from({ length: 200 }, (_, i) => (i % apart === 1 ? 1e-17 * (i + 1) : 0)) }] });
const modes = { kind: 'heatmap', title: 'Modes', x: 't [s]', y: 'contact', x_values: [0, 1, 2], y_values: ['left', 'right'], classes: ['open', 'rolls', 'slides'], values: [[0, 0, 0], [0, 0, 0]] };

/** A page with one more script at its end. */
const planted = (html, script) => {
  const end = html.lastIndexOf('</body>');
  return `${html.slice(0, end)}<script>${script}</script>${html.slice(end)}`;
};

/** A page built from sources in which one text was replaced: a planted bug. block: one, or a list. */
function bent(block, file, from, to) {
  const copy = mkdtempSync(join(folder, 'bent-'));
  for (const part of ['src', 'build.mjs', 'package.json']) cpSync(join(here, '..', part), join(copy, part), { recursive: true });
  symlinkSync(join(here, '../node_modules'), join(copy, 'node_modules'));
  const source = readFileSync(join(copy, 'src', file), 'utf8');
  if (source.split(from).length !== 2) throw new Error(`${file} holds “${from}” not exactly once: plant elsewhere`);
  writeFileSync(join(copy, 'src', file), source.replace(from, () => to));
  const output = join(copy, 'page.html');
  const build = spawnSync(process.execPath, [join(copy, 'build.mjs'), output], { encoding: 'utf8' });
  if (build.status !== 0) throw new Error(`${file} with “${to}” does not build: ${build.stderr}`);
  return fill(readFileSync(output, 'utf8'), JSON.stringify({ title: 'Fault', sections: [{ title: 'One', blocks: [block].flat() }] }));
}

// A disk that turns about its own axis and leaves no trail: only its mark shows it.
const spin = { kind: 'animation', title: 'Spin', view: '3d', times: [0, 8], floor: true, bodies: [{ name: 'disk',
  poses: [[0, 0, 1, 1, 0, 0, 0], [0, 0, 1, Math.SQRT1_2, 0, 0, Math.SQRT1_2]], shapes: [{ shape: 'cylinder', radius: 1, length: 0.2, color: 'accent' }] }] };
/** The table with a first column of names that a filter takes for several words: n = 0, n = 1, … */
const spaced = (table) => ({ ...table, rows: table.rows.map(([, ...rest], i) => [`n = ${i % 7}`, ...rest]) });
const landing = { ...spin, forces: [{ name: 'ground', modes: [0, 1], values: [[0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 9]] }] };
const shaped = (shape) => ({ ...spin, bodies: [{ ...spin.bodies[0], shapes: [shape] }] });

/** name, page, exit status, what the message must say. */
const cases = [
  ['the sample', good, 0, /passed, 0 failed/],
  ['a text alone', small(text), 0, /passed, 0 failed/],
  ['a plot alone', small(plot), 0, /passed, 0 failed/],
  ['broken JSON', fill(page, JSON.stringify(sample).slice(0, 5000)), 1, /FAILED readable data: This report cannot be shown/],
  ['a page never filled', page, 1, /never filled/],
  ['an unknown kind', small({ kind: 'hologram' }), 1, /Unknown kind of block: “hologram”/],
  ['x and y of different lengths', small({ ...plot, series: [{ name: 'a', x: [0, 1], y: [0] }] }), 1, /x has 2 values, y has 1/],
  ['console.error', planted(small(text), 'console.error("planted")'), 1, /console error: planted/],
  ['an exception', planted(small(text), 'throw new Error("planted")'), 1, /page error: planted/],
  ['a request', planted(small(text).replace(/<meta http-equiv[^>]*>/, ''), "new Image().src = 'http://127.0.0.1:9/planted.png'"), 1, /request: http:\/\/127/],
  ['a block that vanished', planted(small(text), 'document.querySelector("[data-block]").remove()'), 1, /number of blocks: 0 of 1/],
  ['a blank chart', planted(small(plot), `addEventListener('load', () => setTimeout(() => {
    document.querySelector('.chart svg').replaceChildren(); }, 60))`), 1, /is not blank/],
  ['something too wide', planted(small(text), "document.body.append(Object.assign(document.createElement('div'), { style: 'width:1500px;height:9px' }))"), 1, /no horizontal overflow at 1280/],
  ['notes before a plot', small(note, note, plot), 1, /the first figure comes before the notes: 2 before it/],
  ['notes behind a plot', small(note, plot, note), 0, /passed, 0 failed/],
  ['a path of tiny numbers', small(tinyPath), 0, /passed, 0 failed/],
  ['a margin that tiny numbers do not fit', () => bent(tinyPath, 'charts/plot.js', 'if (equal) margin.left =', 'if (!data) margin.left ='), 1, /no words are cut at 390 px/],
  ['a heat map alone', small(errorMap), 0, /passed, 0 failed/],
  ['2000 rows of 20 columns', small(longTable(2000, 20)), 0, /passed, 0 failed/],
  ['a heat map with a short row', small({ ...errorMap, values: [[1], ...errorMap.values.slice(1)] }), 1, /row 1 of "values" has 1 entries, "x_values" has 5/],
  ['marks that do not fit', small({ ...errorMap, marks: [] }), 1, /"marks" has 0 rows, "y_values" has 8 values/],
  ['a filter without values', small({ ...convergence, filters: [{ name: 'system' }] }), 1, /the filter system needs the list values/],
  ['a scale turned round', () => bent(errorMap, 'charts/heatmap.js', 'inRange: { color: COLOURS }', 'inRange: { color: [...COLOURS].reverse() }'), 1, /larger is darker/],
  ['rows upside down', () => bent(errorMap, 'charts/heatmap.js', 'if (numbers && block.y_values[ny - 1] > block.y_values[0]) order', 'order'), 1, /larger is darker|is hatched|mark is read out/],
  ['empty cells left white', () => bent(unmarked, 'charts/heatmap.js', ": HATCH }", ": 'var(--paper)' }"), 1, /is hatched and says so/],
  ['a scale that does not fit', () => bent({ ...errorMap, unit: 'largest |E − E0| / |E0| of the run, of all its recorded states' }, 'charts/heatmap.js', 'const long = Math.max(0, Math.min(LONGEST, width - 2 * GAP - words))', 'const long = LONGEST'), 1, /no words are cut at 390 px/],
  ['a name for every row', () => bent(tallMap, 'charts/heatmap.js', 'apart(LINE, row)', '{ interval: 0 }'), 1, /no words of a figure overlap at 390 px/],
  ['triangles of slopes in one place', () => bent(convergence, 'charts/markings.js', 'left + (i + 0.05) * wide', 'left + 0.05 * wide'), 1, /no words of a figure overlap at 390 px/],
  ['a broken option', () => bent({ kind: 'text', paragraphs: ['`--check` estimates it '.repeat(40)] }, 'dom.js', "'short' : null", 'null : null'), 1, /no option is broken at 390 px/],
  ['a dead arrow key', () => bent(errorMap, 'charts/keys.js', 'ArrowDown: columns', 'ArrowDown: 0'), 1, /heat map .*(darker|read out)/],
  ['filters that hide nothing', () => bent(convergence, 'charts/filters.js', '|| tag(tags, name) === select.value', '|| true'), 1, /the first value is chosen at the start: 40 series, not 4/],
  ['fits left out', () => bent(convergence, 'charts/series.js', 's.fit.text || ', ''), 1, /a fit is in the legend/],
  ['moments that crowd', small(strikes), 0, /passed, 0 failed/],
  ['words at every moment', () => bent(strikes, 'charts/markings.js', 'const APART = 14', 'const APART = 0'), 1, /no words of a figure overlap at 1280 px/],
  ['words on the axis', () => bent(strikes, 'charts/markings.js', 'x - from < apart }', 'false }'), 1, /no words of a figure overlap at 390 px/],
  ['few points between gaps', small(sparse(30)), 0, /passed, 0 failed/],
  ['many points between gaps', small(sparse(3)), 0, /passed, 0 failed/],
  ['many points between gaps that are not there', () => bent(sparse(3), 'charts/plot.js', '|| alone.size > 0, showAllSymbol', ', showAllSymbol'), 1, /shows curves: 0 coloured pixels/],
  ['contacts that never close', small(modes), 0, /passed, 0 failed/],
  ['contacts of all modes', small({ ...modes, values: [[0, 1, 1], [0, 2, 0]] }), 0, /passed, 0 failed/],
  ['names of several words', small(spaced(longTable(50, 8))), 0, /passed, 0 failed/],
  ['words that are not looked for', () => bent(longTable(50, 8), 'blocks/table_filter.js', 'text(entry).includes(word)', 'true'), 1, /the words filter the rows/],
  ['a dead drop-down', () => bent(longTable(50, 8), 'blocks/table_filter.js', "=== list[select.value]", '!== undefined'), 1, /a drop-down filters the rows/],
  ['all rows at once', () => bent(longTable(400, 8), 'blocks/table.js', 'const SLICE = 150', 'const SLICE = 1e9'), 1, /made in slices/],
  ['a long table whole on paper', () => bent(longTable(200, 8), 'blocks/table.js', 'grow(Math.min(order.length, PRINTED))', 'grow(order.length)'), 1, /tables on paper are short/],
  ['parts of a table kept together on paper', () => bent(longTable(20, 20), 'print.css', '.table-block:not(:has(.tall, div.part))', '.table-block:not(:has(.tall))'), 1, /does not ask for a page of its own: 1 do/],
  ['long parts of a table kept whole on paper', () => bent(longTable(60, 20), 'blocks/table.js', "box.matches('.tall') ? 'part tall' : 'part'", "'part'"), 1, /does not ask for a page of its own: 3 do/],
  ['rows that never come', () => bent(longTable(400, 8), 'blocks/table.js', 'grow(body.childElementCount + SLICE)', 'grow(0)'), 1, /scrolling makes more rows/],
  ['a moving body alone', small(spin), 0, /passed, 0 failed/],
  ['data that do not fit the schema', small({ ...plot, log: true }), 1, /the data fit schema.json: .*blocks.0/],
  ['an unknown shape', small(shaped({ shape: 'cone' })), 1, /body 1 \(disk\): unknown shape “cone”; known are box, cylinder/],
  ['a sphere without radius', small(shaped({ shape: 'sphere' })), 1, /a sphere needs “radius”/],
  ['an unknown colour', small(shaped({ shape: 'sphere', radius: 1, color: 'blue' })), 1, /unknown color “blue”; known are body, accent/],
  ['too few poses', small({ ...spin, times: [0, 1, 2] }), 1, /has 2 poses for 3 times/],
  ['times that stand', small({ ...spin, times: [1, 1] }), 1, /"times" do not rise/],
  ['a clock that stands', () => bent(spin, 'stage/animation.js', '* speed.value)', '* 0)'), 1, /: plays/],
  ['a body that rests', small({ ...spin, bodies: [{ ...spin.bodies[0], poses: [spin.bodies[0].poses[0], spin.bodies[0].poses[0]] }] }), 0, /passed, 0 failed/],
  ['a force that comes later', small(landing), 0, /passed, 0 failed/],
  ['arrows that do not come', () => bent(landing, 'stage/animation.js', 'pushing() ? arrowOf(', 'false ? arrowOf('), 1, /: arrows appear: 0 differences/],
  ['no pause', () => bent(body(), 'stage/animation.js', "const pause = () => {\n    playing = false;", 'const pause = () => {'), 1, /: pauses/],
  ['a dead bar', () => bent(spin, 'stage/animation.js', 'seek(start + (bar.value / TICKS) * (end - start));', ''), 1, /: scrubs to the end/],
  ['bodies that stand', () => bent(spin, 'stage/animation.js', 'stand(body, at[b])', 'stand(body, motion.bodies[b].poses[0])'), 1, /: the body has moved/],
  ['a disk without its mark', () => bent(spin, 'stage/shapes.js', 'lit(markOf(colour), shell), 2', 'lit(colour, shell), 2'), 1, /: the body has moved/],
  ['dead keys', () => bent(spin, 'stage/stage.js', 'controls.rotateLeft(TURN)', 'controls.rotateLeft(0)'), 1, /: an arrow key turns the view/],
  ['no dragging', () => bent(spin, 'stage/stage.js', 'enableDamping: false', 'enableRotate: false'), 1, /: dragging turns the view/],
  ['no way home', () => bent(spin, 'stage/animation.js', 'stage.goTo(stage.from); }', '}'), 1, /: the view resets/],
  ['a figure that waits', () => bent(plot, 'sections.js', 'Promise.resolve(draw())', 'new Promise((done) => { setTimeout(done, 4000); }).then(draw)'), 1, /plain screenshot: A plot shows curves: 0/],
  ['a first drawing that stays too wide', () => bent(plot, 'figures.css', '.chart > div:first-child { max-width: 100%; }', ''), 1, /drawings shrink with their cards: 1 do not/],
  ['no word about WebGL', () => bent(spin, 'stage/stage.js', 'Drawn without WebGL', 'Drawn'), 1, /drawn all the same and say so: 1 say nothing/],
  ['a saved figure without its colours', () => bent(plot, 'save.js', 'print.getPropertyValue(name).trim()', '`var(${name})`'), 1, /SVG: colours of its own/],
  ['an ensemble', small(members, classMap, memberDots, matrix), 0, /passed, 0 failed/],
  ['4000 dots in ten pairs', small({ ...members, count: 100000, index: crowd(4000).members, columns: [], failures: {}, motions: {} }, crowd(4000)), 0, /passed, 0 failed/],
  ['a scatter matrix without members', small({ ...matrix, members: undefined }), 0, /passed, 0 failed/],
  ['columns of different lengths', small({ ...matrix, columns: [matrix.columns[0], { name: 'b', values: [1] }] }), 1, /column b has 1 values, angle has 40/],
  ['members without values', small({ ...members, columns: [{ name: 'b', values: [1] }] }), 1, /column b has 1 values, there are 40 members/],
  ['maps one a row on paper', () => bent([members, classMap, wideMap, wideMap], 'print.css', ':is(.wide, .heatmap):not(.paired)', ':is(.wide, .heatmap)'), 1, /two a row on paper: 1 are not/],
  ['wide maps two a row on paper', small(members, wideMap, wideMap, matrix), 0, /passed, 0 failed/],
  ['a click that chooses another', () => bent([members, classMap], 'charts/heatmap.js', "({ dataIndex }) => choose(member(dataIndex), holder)", '({ dataIndex }) => choose(member(dataIndex + 1), holder)'), 1, /heatmap: a click there shows a member/],
  ['rows of members upside down', () => bent([members, classMap], 'charts/heatmap.js', 'order.map((i) => block.members[i])', 'block.members'), 1, /heatmap: the first cell is that member/],
  ['a dead click on dots', () => bent([members, memberDots], 'charts/choosing.js', "chart.getZr().on('click'", "chart.getZr().on('none'"), 1, /plot: a click there shows a member/],
  ['a dead Enter', () => bent([members, memberDots], 'charts/keys.js', "event.key === 'Enter' &&", 'false &&'), 1, /plot: Enter shows the member/],
  ['a matrix that finds no dot', () => bent([members, matrix], 'charts/scatter.js', 'if (away < distance) [best', 'if (away < 0) [best'), 1, /scatter: a click there shows a member/],
  ['a matrix that marks another', () => bent([members, matrix], 'charts/scatter.js', 'if (i >= 0 && data.members) choose(data.members[i], holder)', 'if (i >= 0 && data.members) choose(data.members[(i + 7) % data.count], holder)'), 1, /scatter: the mark is where the click was/],
  ['a matrix without dots', () => bent(matrix, 'charts/scatter.js', 'if (c >= r) continue;\n      const d', 'if (c >= 0) continue;\n      const d'), 1, /every pair has its dots: 0 dots/],
  ['a command line of another member', () => bent([members, classMap], 'blocks/members.js', "replace('{}', member)", "replace('{}', member + 1)"), 1, /a member is shown by its number, with its command line/],
  ['a motion that is not there', () => bent([members, classMap], 'blocks/members.js', 'store.motions[member] ?? []', '[]'), 1, /the motion of a member is drawn in its box/],
  ['classes on a scale', () => bent(classMap, 'charts/heatmap.js', 'scaled: min < max && !classes', 'scaled: min < max'), 1, /no scale of numbers/],
  ['classes of one colour', () => bent(classMap, 'charts/heatmap.js', 'map.classes[value]?.colour ?? HATCH', 'map.classes[0].colour'), 1, /a colour for each class/],
  ['ticks that stay when zoomed', () => bent(plot, 'charts/zoom.js', 'zoomed ? { x: ranges[0]', 'false ? { x: ranges[0]'), 1, /a drag zooms|has ticks/],
];

/** What is also looked at by `chromium --headless --screenshot`: every kind of block, and what only a plain picture shows. */
const ALONE = new Set(['the sample', 'a figure that waits', 'a plot alone']);
cases.push(...cases.filter(([name]) => name === 'a figure that waits').map(([, ...rest]) => ['a figure that waits, in the running browser', ...rest]));

const asked = cases.filter(([name]) => name.includes(process.argv[3] ?? ''));

let [passed, failed] = [0, 0];
function judge(name, good, detail = '') {
  if (good) ++passed;
  else ++failed, console.log(`FAILED ${name}${detail}`);
}

units.forEach(([name, good]) => judge(name, good));

const server = await serve();

/** render.mjs on a page -> {status, said}; `alone`: with a browser of its own, and chromium's own commands. */
const look = (file, alone) => new Promise((resolve) => {
  const env = { ...process.env, HAMEL_BROWSER: alone ? '' : server.wsEndpoint() };
  const run = spawn(process.execPath, [join(here, 'render.mjs'), file], { env });
  let said = '';
  for (const stream of [run.stdout, run.stderr]) stream.on('data', (data) => { said += data; });
  run.on('close', (status) => resolve({ status, said }));
});

let next = 0;
async function work() {
  while (next < asked.length) {
    const number = next++;
    const [name, html, status, message] = asked[number];
    const file = join(folder, `page${number}.html`);
    writeFileSync(file, typeof html === 'function' ? html() : html);
    const run = await look(file, ALONE.has(name));
    judge(name, run.status === status && message.test(run.said), `: exit status ${run.status}, not ${status}, or not ${message}:\n${run.said}`);
  }
}
await Promise.all([work(), work()]);
await server.close();
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
