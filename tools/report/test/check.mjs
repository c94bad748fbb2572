// node test/check.mjs [BUILT.html]: the sample page passes render.mjs, and pages with a planted fault do not.

import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { fill } from './fill.mjs';
import { sample } from './sample_data.mjs';

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
];

let [passed, failed] = [0, 0];
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
