// node tools/docs/picture.mjs PAGE BUILD NAME FIGURE      PAGE: a page of hamel run --report; BUILD: a build folder
// Cuts a picture of that name, in this folder, out of the page: the motion beside the figure of that title. Uses the page's own test set-up
// (BUILD/tools/report).

import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const [report, build, name, beside] = process.argv.slice(2);
const { launch } = await import(pathToFileURL(resolve(build, 'tools/report/test/browser.mjs')));

const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1240, height: 900 }, deviceScaleFactor: 1.5 });
await page.goto(pathToFileURL(resolve(report)).href);
await page.waitForSelector('html[data-ready=true]', { state: 'attached' });
await page.evaluate((other) => {
  const figures = [...document.querySelectorAll('figure')];
  const titles = figures.map((figure) => figure.querySelector('.title').textContent);
  const wanted = ['Motion', other].map((title) => figures[titles.indexOf(title)]);
  if (wanted.includes(undefined)) throw new Error(`no figure '${other}'; expected one of ${titles.join(', ')}`);
  const pair = document.querySelector('.figures');
  pair.replaceChildren(...wanted);
  pair.id = 'pair';
  const bar = wanted[0].querySelector('.bar');
  bar.value = 0.62 * bar.max;
  bar.dispatchEvent(new Event('input'));
  document.querySelectorAll('.tools, .player').forEach((element) => element.remove());
}, beside);
await page.setViewportSize({ width: 1200, height: 900 });  // drawn again for their new places
await page.waitForTimeout(500);
await page.locator('#pair').screenshot({ path: join(here, `${name}.png`) });
await browser.close();
