// node test/render.mjs PAGE.html [--screenshot OUT.png] [--narrow OUT.png] [--pdf OUT.pdf] [--fallback OUT.png] [--plain OUT.png]
// node test/render.mjs PAGE.html PAGE.html...
// Opens reports in one headless Chromium and fails on anything that is not as it should be. Plain pictures are taken of the first by
// chromium's own commands, of the others and with $HAMEL_BROWSER by the browser that runs. Exit status: 0 passed, 1 failed, 2 wrong use,
// 77 no browser here.

import { existsSync } from 'node:fs';
import { launch } from './browser.mjs';
import { look } from './look.mjs';

const files = [];
const options = {};
for (let words = process.argv.slice(2); words.length > 0; words = words.slice(1)) {
  if (words[0].startsWith('--')) options[words.shift().replace(/^--/, '')] = words[0];
  else files.push(words[0]);
}
const absent = files.filter((file) => !existsSync(file));
if (files.length === 0 || absent.length > 0 || (files.length > 1 && Object.keys(options).length > 0)) {
  console.error('usage: node test/render.mjs PAGE.html [--screenshot|--narrow|--pdf|--fallback|--plain OUT]\n       node test/render.mjs PAGE.html...');
  absent.forEach((file) => console.error(`there is no ${file}`));
  process.exit(2);
}

const browser = await launch();
let failed = false;
for (const file of files) {
  const { passed, failures } = await look(browser, file, { commands: !process.env.HAMEL_BROWSER && file === files[0], options });
  if (files.length > 1) console.log(`${file}:`);
  failures.forEach((text) => console.log(text));
  console.log(`${passed} passed, ${failures.length} failed`);
  failed ||= failures.length > 0;
}
await browser.close();
process.exit(failed ? 1 : 0);
