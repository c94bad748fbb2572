// node test/render.mjs PAGE.html [--screenshot OUT.png] [--narrow OUT.png] [--pdf OUT.pdf] [--fallback OUT.png] [--plain OUT.png]
// node test/render.mjs PAGE.html PAGE.html...
// Opens reports in headless Chromium and fails on anything that is not as it should be. Plain pictures are taken of the first by
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

// The pages wait more than they work (animations, hints): several browsers look at them side by side.
const AT_A_TIME = 3;
const results = [];
let next = 0;
async function work() {
  const browser = await launch();
  for (let i = next++; i < files.length; i = next++)
    results[i] = await look(browser, files[i], { commands: !process.env.HAMEL_BROWSER && i === 0, options });
  await browser.close();
}
await Promise.all(Array.from({ length: Math.min(AT_A_TIME, files.length) }, work));
let failed = false;
results.forEach(({ passed, failures }, i) => {
  if (files.length > 1) console.log(`${files[i]}:`);
  failures.forEach((text) => console.log(text));
  console.log(`${passed} passed, ${failures.length} failed`);
  failed ||= failures.length > 0;
});
process.exit(failed ? 1 : 0);
