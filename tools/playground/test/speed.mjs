// node speed.mjs BUILD [COUNT]: how long the page takes to its first motion, COUNT times with a browser that has loaded nothing before, and what a
// picture of a motion costs: pictures a second, and of each the time of the page's own code. No test: figures of a machine with its load.

import { loadavg } from 'node:os';
import { address, browser, close, complete, launch, open } from './visit.mjs';

const count = Number(process.argv[3] ?? 7);
const median = (all) => [...all].sort((a, b) => a - b)[Math.floor(all.length / 2)];
const told = (all) => `${median(all)} ms (${Math.min(...all)} to ${Math.max(...all)})`;

/** Runs in the page before all else: the time that callbacks of pictures take. */
function watchPictures() {
  const ask = requestAnimationFrame.bind(globalThis);
  globalThis.pictures = [];
  globalThis.requestAnimationFrame = (callback) => ask((now) => {
    const begun = performance.now();
    callback(now);
    globalThis.pictures.push({ now, took: performance.now() - begun });
  });
}

for (const name of ['', '#rolling_disk', '#segway']) {
  const [first, ran] = [[], []];
  for (let i = 0; i < count; ++i) {
    const cold = await launch();
    const page = await (await cold.newContext({ viewport: { width: 1280, height: 900 } })).newPage();
    await page.goto(`${address}${name}`);
    await page.waitForSelector('html[data-ready=true]', { state: 'attached' });
    ran.push(await page.evaluate(() => Math.round(performance.now())));
    first.push(Number(await page.getAttribute('html', 'data-first')));
    await cold.close();
  }
  console.log(`${name || '(the address alone)'}: first motion ${told(first)}, first run of the library ${told(ran)}, at a load of ${loadavg()[0].toFixed(1)}`);
}

for (const name of ['bicycle', 'rattleback', 'car']) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 } });
  await context.addInitScript(watchPictures);
  const page = await open(`${address}#${name}`, { context });
  await complete(page);
  await page.waitForSelector('#figures[data-drawn=true]', { state: 'attached' });
  const pictures = await page.evaluate(async () => {
    const play = document.querySelector('#motion .play');
    if (play.textContent.includes('play')) play.click();
    globalThis.pictures.length = 0;
    await new Promise((done) => { setTimeout(done, 3000); });
    return globalThis.pictures;
  });
  const seconds = (pictures.at(-1).now - pictures[0].now) / 1000;
  const took = pictures.map((one) => one.took).sort((a, b) => a - b);
  console.log(`${name}: ${((pictures.length - 1) / seconds).toFixed(0)} pictures a second by software WebGL; own code ${median(took).toFixed(2)} ms a picture, ` +
    `${took[Math.floor(0.95 * took.length)].toFixed(2)} at most in 95 of 100; at a load of ${loadavg()[0].toFixed(1)}`);
  await context.close();
}
await close();
