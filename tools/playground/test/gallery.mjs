// node gallery.mjs BUILD: every link from the documentation site to the playground runs in the module, to its end, and every entry of the
// gallery and every file of the tutorial has one. Exit status: 0 passed, 1 failed, 77 where the module or the site is not built.

import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileOf, stateOfFragment } from '../page/src/state.js';
import { openModule } from './module.mjs';

const build = resolve(process.argv[2] ?? 'build');
const site = join(build, 'docs/html');
for (const file of [join(site, 'gallery.html'), join(build, 'playground/wasm/tools/playground/hamel.wasm')]) {
  if (!existsSync(file)) {
    console.log(`skipped: no ${file}`);
    process.exit(77);
  }
}
const pages = readdirSync(site, { recursive: true }).filter((name) => name.endsWith('.html') && !name.startsWith('playground'));
const linksOf = (name) => [...readFileSync(join(site, name), 'utf8').matchAll(/href="(?:\.\.\/)*playground\/index\.html(#[^"]*)"/g)].map(([, fragment]) => fragment);
const matches = (name, pattern) => [...readFileSync(join(site, name), 'utf8').matchAll(pattern)];
const links = [...new Set(pages.flatMap(linksOf))];
const library = await openModule(build);
let failed = 0;
function fail(what) {
  ++failed;
  console.log(`FAILED: ${what}`);
}
const entries = matches('gallery.html', /class="tiles">(.*?)<\/div>/gs).flatMap(([, tiles]) => [...tiles.matchAll(/<a /g)]).length;
const files = matches('tutorial/ten_minutes.html', /\.toml<\/span>/g).length;
for (const [name, count] of [['gallery.html', entries], ['tutorial/ten_minutes.html', files]])
  if (count === 0 || linksOf(name).filter((link) => link.startsWith('#~')).length !== count) fail(`${name}: ${linksOf(name).length} links of ${count} files and systems`);
for (const link of links) {
  const state = await stateOfFragment(link);
  state.text ??= library.call('text', { name: state.system }).text;
  const { options, parameters, inputs, text } = state;
  const answer = library.call('run', { text, origin: fileOf(state), options, parameters, inputs });
  if (!answer.ok || answer.failure) fail(`${state.system || fileOf(state)}: ${answer.failure || answer.mistakes.join('; ')}`);
  else console.log(`${state.system || fileOf(state)}: ${answer.steps} steps to t = ${answer.time}`);
}
console.log(`${links.length - failed} of ${links.length} run`);
process.exit(failed ? 1 : 0);
