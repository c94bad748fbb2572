// node test/check.mjs [BUILT.html]: the sample page passes render.mjs, and pages with a planted fault do not.

import { spawnSync } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { fill } from './fill.mjs';
import { luminance, sequential } from '../src/colours.js';
import { sample } from './sample_data.mjs';
import { convergence, errorMap, longTable } from './sample_study.mjs';

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
const small = (block) => fill(page, JSON.stringify({ title: 'Fault', sections: [{ title: 'One', blocks: [block] }] }));
const text = { kind: 'text', paragraphs: ['A text.'] };
const series = [{ name: 'a', x: [0, 1, 2], y: [0, 1, 0] }];
const plot = { kind: 'plot', title: 'A plot', x: 'x', y: 'y', series };
const unmarked = { ...errorMap, marks: undefined };

/** A page built from sources in which one text was replaced: a planted bug. */
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
  return fill(readFileSync(output, 'utf8'), JSON.stringify({ title: 'Fault', sections: [{ title: 'One', blocks: [block] }] }));
}

/** name, page, exit status, what the message must say. */
const cases = [
  ['the sample', good, 0, /passed, 0 failed/],
  ['a text alone', small(text), 0, /passed, 0 failed/],
  ['a plot alone', small(plot), 0, /passed, 0 failed/],
  ['broken JSON', fill(page, JSON.stringify(sample).slice(0, 5000)), 1, /FAILED readable data: This report cannot be shown/],
  ['a page never filled', page, 1, /never filled/],
  ['an unknown kind', small({ kind: 'hologram' }), 1, /Unknown kind of block: “hologram”/],
  ['x and y of different lengths', small({ ...plot, series: [{ name: 'a', x: [0, 1], y: [0] }] }), 1, /x has 2 values, y has 1/],
  ['console.error', small(text).replace('</body>', '<script>console.error("planted")</script></body>'), 1, /console error: planted/],
  ['an exception', small(text).replace('</body>', '<script>throw new Error("planted")</script></body>'), 1, /page error: planted/],
  ['a request', small(text).replace(/<meta http-equiv[^>]*>/, '')
    .replace('</body>', '<img alt="" src="http://127.0.0.1:9/planted.png"></body>'), 1, /request: http:\/\/127/],
  ['a block that vanished', small(text).replace('</body>', '<script>document.querySelector("[data-block]").remove()</script></body>'), 1, /number of blocks: 0 of 1/],
  ['a blank chart', small(plot).replace('</body>', `<script>addEventListener('load', () => setTimeout(() => {
    const c = document.querySelector('.chart canvas'); c.width = c.width; }, 60));</script></body>`), 1, /is not blank/],
  ['something too wide', small(text).replace('</body>', '<div style="width:1500px;height:9px"></div></body>'), 1, /no horizontal overflow at 1280/],
  ['a heat map alone', small(errorMap), 0, /passed, 0 failed/],
  ['2000 rows of 20 columns', small(longTable(2000, 20)), 0, /passed, 0 failed/],
  ['a heat map with a short row', small({ ...errorMap, values: [[1], ...errorMap.values.slice(1)] }), 1, /row 1 of "values" has 1 entries, "x_values" has 5/],
  ['marks that do not fit', small({ ...errorMap, marks: [] }), 1, /"marks" has 0 rows, "y_values" has 8 values/],
  ['a filter without values', small({ ...convergence, filters: [{ name: 'system' }] }), 1, /the filter system needs the list values/],
  ['a scale turned round', bent(errorMap, 'heatmap_draw.js', 'sequential(part(map, cell.at))', 'sequential(1 - part(map, cell.at))'), 1, /larger is darker/],
  ['rows upside down', bent(errorMap, 'heatmap.js', 'if (rises)', 'if (!rises)'), 1, /larger is darker|is hatched/],
  ['empty cells left white', bent(unmarked, 'heatmap_draw.js', 'cell.missing ? hatch : ', ''), 1, /is hatched and says so/],
  ['a dead arrow key', bent(errorMap, 'heatmap.js', 'ArrowDown: [0, 1]', 'ArrowDown: [0, 0]'), 1, /heat map .*(darker|read out)/],
  ['filters that hide nothing', bent(convergence, 'filters.js', '|| tag(tags, name) === select.value', '|| true'), 1, /the first value is chosen at the start: 40 series, not 4/],
  ['fits left out', bent(convergence, 'curves.js', 'String(fit.text ||', 'String('), 1, /a fit is in the legend/],
  ['words that are not looked for', bent(longTable(50, 8), 'table_filter.js', 'text(entry).includes(word)', 'true'), 1, /the words filter the rows/],
  ['a dead drop-down', bent(longTable(50, 8), 'table_filter.js', "=== list[select.value]", '!== undefined'), 1, /a drop-down filters the rows/],
  ['all rows at once', bent(longTable(400, 8), 'table.js', 'const SLICE = 150', 'const SLICE = 1e9'), 1, /made in slices/],
  ['rows that never come', bent(longTable(400, 8), 'table.js', 'grow(body.childElementCount + SLICE)', 'grow(0)'), 1, /scrolling makes more rows/],
];

let [passed, failed] = [0, 0];
const lights = Array.from({ length: 101 }, (_, i) => luminance(sequential(i / 100)));
if (lights.every((light, i) => i === 0 || light < lights[i - 1])) ++passed;
else ++failed, console.log('FAILED the colour scale gets darker throughout');
for (const [name, html, status, message] of cases) {
  const file = join(folder, 'page.html');
  writeFileSync(file, html);
  const run = spawnSync(process.execPath, [join(here, 'render.mjs'), file], { encoding: 'utf8' });
  if (run.status === 77) {
    console.log(run.stdout.trim());
    process.exit(77);
  }
  const said = run.stdout + run.stderr;
  if (run.status === status && message.test(said)) {
    ++passed;
  } else {
    ++failed;
    console.log(`FAILED ${name}: exit status ${run.status}, not ${status}, or not ${message}:\n${said}`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
