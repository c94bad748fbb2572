// node tools/docs/picture.mjs BUILD      BUILD: a build folder with tools/hamel and reproduce/report.html
// Cuts tools/docs/readings.png out of the page that `hamel reproduce` wrote: two figures of its section
// "Figure 1 with Cayley", side by side. Uses the page's own test set-up (BUILD/tools/report).

import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const [build = 'build', report = join(build, 'reproduce/report.html')] = process.argv.slice(2);
const { launch } = await import(pathToFileURL(resolve(build, 'tools/report/test/browser.mjs')));

const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1400, height: 900 }, deviceScaleFactor: 1.25 });
await page.goto(pathToFileURL(resolve(report)).href);
await page.waitForSelector('html[data-ready=true]', { state: 'attached' });
// Only the wanted section, and in it only the wanted figures.
await page.evaluate(() => {
  const wanted = ['Energy error', 'Trajectory error: body velocity'];
  const sections = [...document.querySelectorAll('section')];
  const section = sections.find((s) => s.querySelector('h2')?.textContent === 'Figure 1 with Cayley');
  for (const figure of section.querySelectorAll('figure')) {
    if (!wanted.includes(figure.querySelector('.title').textContent)) figure.remove();
  }
  document.body.style.background = 'white';
});
// The unadapted reading swings over ten decades and would cover the others: it is left out.
for (const entry of await page.locator('section .legend .entry', { hasText: /^unadapted/ }).all()) {
  if (await entry.isVisible()) await entry.click();
}
await page.setViewportSize({ width: 1360, height: 900 });  // the charts are drawn again for their new places
await page.waitForTimeout(400);
const pair = page.locator('section', { has: page.locator('h2', { hasText: /^Figure 1 with Cayley$/ }) })
  .locator('.figures').first();
await pair.screenshot({ path: join(here, 'readings.png') });
await browser.close();
