// node gallery.mjs BUILD: every link from the gallery of the documentation site to the playground runs in the module, to its end. Exit
// status: 0 passed, 1 failed, 77 where the module or the site is not built.

import { existsSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileOf, stateOfFragment } from '../page/src/state.js';
import { openModule } from './module.mjs';

const build = resolve(process.argv[2] ?? 'build');
const page = join(build, 'docs/html/gallery.html');
for (const file of [page, join(build, 'playground/wasm/tools/playground/hamel.wasm')]) {
  if (!existsSync(file)) {
    console.log(`skipped: no ${file}`);
    process.exit(77);
  }
}
const html = readFileSync(page, 'utf8');
const links = [...html.matchAll(/href="playground\/index\.html(#[^"]*)"/g)].map(([, fragment]) => fragment);
const entries = [...html.matchAll(/class="tiles">(.*?)<\/div>/gs)].flatMap(([, tiles]) => [...tiles.matchAll(/<a /g)]).length;
const library = await openModule(build);
let failed = 0;
function fail(what) {
  ++failed;
  console.log(`FAILED: ${what}`);
}
if (links.length === 0 || links.length !== entries) fail(`${links.length} links of ${entries} entries`);
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
