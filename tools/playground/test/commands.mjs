// node commands.mjs BUILD: the commands of the page's terminal print what the program prints, and write the pages that it writes. Exit status:
// 0 passed, 1 failed, 77 where the module or the program is not built.

import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { openModule } from './module.mjs';

const build = resolve(process.argv[2] ?? 'build');
const program = join(build, 'tools/hamel');
for (const file of [program, join(build, 'playground/wasm/tools/playground/hamel.wasm')]) {
  if (!existsSync(file)) {
    console.log(`skipped: no ${file}`);
    process.exit(77);
  }
}
const CART = 'name = "cart"\nbody = [{ name = "cart", mass = 10, at = [0, 0, 0.1], box = [0.5, 0.3, 0.1] }]\njoint = [{ name = "floor", kind = "planar", child = "cart" }]\n' +
  'blade = [{ name = "axle", body = "cart", at = [-0.2, 0, 0] }]\n[start]\nv1 = 1\nomega = 0.5\n';
const TURNS = 'system = "chaplygin_sleigh"\nuntil = 5\ngrid = true\nkeep = ["end.theta"]\n[vary]\nstart.omega = { range = [-3, 3, 4] }\nstart.v1 = { range = [-1.5, 1.5, 3] }\n';
const STEPS = 'title = "Steps"\nuntil = 2\nrepeats = 1\nscheme = ["lift", "balance"]\nstep = [0.1, 0.05]\n[[system]]\nname = "suslov"\nvelocity = [1, 0.5, 0]\n';
const files = { 'cart.toml': CART, 'turns.toml': TURNS, 'steps.toml': STEPS };
const LINES = [
  ['list schemes'], ['help steady'], ['describe cart.toml --analyse'], ['describe chaplygin_sleigh --equations latex'],
  ['run cart.toml --until 2 --check'], ['run cart.toml --until 2 --report page.html', 'page.html'],
  ['steady bicycle --vary speed=1:8:8 --report page.html', 'page.html'], ['section rattleback --event reversed --count 3 --until 200 --report page.html', 'page.html'],
  ['ensemble turns.toml -o out --fresh --quiet', 'out/report.html'], ['study steps.toml -o out --fresh --quiet', 'out/report.html'],
  ['run cart.toml --utnil 2'], ['run no_such_system'], ['steady cart.toml --vary mass'],
];
const TIMES = /^.*\b(time|seconds)\b.*$/gim;  // of a run here and there
const numbers = (text) => (text.match(/-?\d+(\.\d+)?(e[-+]\d+)?/g) ?? []).map(Number);
const shape = (text) => text.replace(TIMES, '').replace(/-?\d+(\.\d+)?(e[-+]\d+)?/g, '#').replace(/\s+/g, ' ').trim();
const kinds = (page) => page.sections.map(({ title, blocks }) => `${title}: ${blocks.map(({ kind, title: of }) => `${kind} ${of ?? ''}`).join(', ')}`).join('; ');

const library = await openModule(build);
let [passed, failed] = [0, 0];
function check(line, what, good, more) {
  if (good) return ++passed;
  ++failed;
  console.log(`FAILED hamel ${line}: ${what}: ${more}`.slice(0, 1500));
}
for (const [line, page] of LINES) {
  const here = library.call('command', { words: line.split(' '), files });
  const folder = mkdtempSync(join(tmpdir(), 'hamel-commands-'));
  Object.entries(files).forEach(([name, text]) => writeFileSync(join(folder, name), text));
  const { stdout, stderr, status } = spawnSync(program, [...line.split(' '), ...(/^(ensemble|study)/.test(line) ? ['--threads', '1'] : [])], { cwd: folder, encoding: 'utf8' });
  const there = stdout + stderr;
  check(line, 'its status', here.ok && here.status === status, `${here.status ?? here.mistakes}, not ${status}`);
  check(line, 'its words', here.ok && shape(here.text) === shape(there), `${here.text}\nnot\n${there}`);
  const [a, b] = [here.text ?? '', there].map((text) => numbers(text.replace(TIMES, '')));
  const worst = a.findIndex((v, i) => Math.abs(v - b[i]) > 1e-5 * Math.abs(b[i]) + 1e-9);
  check(line, 'its numbers', worst < 0, `${a[worst]}, not ${b[worst]}`);
  if (page) {
    const other = JSON.parse(/id="hamel-data">(.*?)<\/script>/s.exec(readFileSync(join(folder, page), 'utf8'))[1]);
    const mine = here.pages?.find(({ file }) => file === page)?.page;
    check(line, 'its page', mine && kinds(mine) === kinds(other), `${mine && kinds(mine)}, not ${kinds(other)}; there are ${readdirSync(folder)}`);
  }
  rmSync(folder, { recursive: true });
}
check('live', 'a command of no page says so', library.call('command', { words: ['live', 'bicycle'], files }).text?.includes('not in a page'), 'nothing said');
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
