// node compare.mjs BUILD [SYSTEM …]: every registered system run by the module and by the program. The same states: with steps of one
// size to 1e-12, with chosen steps to ten times their tolerance, relative to the largest number of a column. Exit status: 0 passed,
// 1 failed, 77 where the module or the program is not built.

import { spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { openModule } from './module.mjs';

const [build, ...only] = process.argv.slice(2);
if (!build) {
  console.error('usage: node compare.mjs BUILD [SYSTEM …]');
  process.exit(2);
}
const program = resolve(build, 'tools/hamel');
for (const file of [program, join(build, 'playground/wasm/tools/playground/hamel.wasm')]) {
  if (!existsSync(file)) {
    console.log(`skipped: no ${file}`);
    process.exit(77);
  }
}

const UNTIL = 5;
const RTOL = 1e-8;
const WAYS = {
  fixed: { options: { scheme: 'lift', step: '0.01' }, most: 1e-12 },
  chosen: { options: { scheme: 'dop853', rtol: String(RTOL), output_step: '0.05' }, most: 10 * RTOL },  // rows at the same times
};
// The C library of WebAssembly rounds the sine and the cosine otherwise in the last place. Motions in which such a difference grows,
// with the reason, and by how much they may differ.
const UNSTABLE = {
  ballbot: { why: 'a body upright on a ball falls', fixed: 1e-8 },
  bicycle: { why: 'nothing turns it back to its heading: the way aside grows with the time', fixed: 1e-10 },
  segway: { why: 'a body upright on wheels falls', fixed: 1e-8 },
  unicycle_rider: { why: 'a rider upright on a wheel falls', fixed: 1e-4 },
};

/** The columns of the state: not what is measured, whose size is round-off. */
const stateColumns = (columns) => columns.slice(0, columns.indexOf('energy'));

function native(name, options) {
  const words = ['run', name, '-o', '-', '--no-exact', '--until', String(UNTIL)];
  for (const [option, value] of Object.entries(options)) words.push(`--${option.replaceAll('_', '-')}`, value);
  const { stdout, stderr, status } = spawnSync(program, words, { encoding: 'utf8', maxBuffer: 1 << 28 });
  const [head, ...lines] = stdout.split('\n').filter((line) => line && !line.startsWith('#'));
  return { status, stderr, columns: head?.split(',') ?? [], rows: lines.map((line) => line.split(',').map(Number)) };
}

const library = await openModule(resolve(build));
const { systems } = library.call('catalogue');
let [failed, passed] = [0, 0];
for (const { name } of systems) {
  if (only.length && !only.includes(name)) continue;
  const { text } = library.call('text', { name });
  for (const [way, { options, most }] of Object.entries(WAYS)) {
    const begun = performance.now();
    const answer = library.call('run', { text, options: { ...options, until: String(UNTIL), no_exact: 'true' } });
    const milliseconds = performance.now() - begun;
    const other = native(name, options);
    const fail = (why) => {
      ++failed;
      console.log(`FAILED ${name}, ${way}: ${why}`);
    };
    if (!answer.ok || Boolean(answer.failure) !== (other.status !== 0)) {
      fail(`${answer.failure || answer.mistakes?.join('; ') || 'ran'}; the program: ${other.stderr.trim() || 'ran'}`);
      continue;
    }
    const columns = answer.columns.length;
    if (answer.rows !== other.rows.length || answer.columns.join() !== other.columns.join()) {
      fail(`${answer.rows} rows of ${answer.columns}; the program: ${other.rows.length} of ${other.columns}`);
      continue;
    }
    const values = library.numbers('rows', answer.rows * columns);
    let [worst, where] = [0, ''];
    stateColumns(answer.columns).forEach((column, j) => {
      const size = Math.max(1, ...other.rows.map((row) => Math.abs(row[j])));
      other.rows.forEach((row, i) => {
        const difference = Math.abs(values[i * columns + j] - row[j]) / size;
        if (!(difference <= worst)) [worst, where] = [difference, `${column} at t = ${row[0]}`];
      });
    });
    const bound = UNSTABLE[name]?.[way] ?? most;
    if (worst <= bound) ++passed; else fail(`differs by ${worst.toExponential(1)} in ${where}, at most ${bound}`);
    console.log(`${name}, ${way}: ${worst.toExponential(1)}${where ? ` in ${where}` : ''}${UNSTABLE[name]?.[way] ? ` (${UNSTABLE[name].why})` : ''}; ${answer.steps} steps, ${milliseconds.toFixed(0)} ms with figures`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
