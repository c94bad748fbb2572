// The page as `chromium --headless --screenshot` and `--print-to-pdf` take it: at once, without waiting for anything.
// By these commands, or by the browser that already runs, which is asked for the same: a command takes four times as long.

import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { inflateSync } from 'node:zlib';
import { executable, PATIENCE } from './browser.mjs';
import { countPixels } from './pixels.mjs';

const PHONE = 390;      // pixels
const TALLEST = 15000;  // pixels of a picture; a longer page is looked at down to there

/** What a plain chromium writes, started for this alone. */
const commands = {
  run(file, output, ...flags) {
    const run = spawnSync(executable(), ['--headless', '--no-sandbox', '--hide-scrollbars', ...flags, pathToFileURL(resolve(file)).href],
      { encoding: 'utf8', timeout: 400000 });
    if (run.status !== 0) throw new Error(`chromium ${flags.join(' ')}: ${run.stderr}`);
    return readFileSync(output);
  },
  screenshot(file, output, width, height) { return this.run(file, output, `--screenshot=${output}`, `--window-size=${width},${height}`); },
  print(file, output) { return this.run(file, output, `--print-to-pdf=${output}`); },
};

/** The same in a fresh context of the browser, where the page has been loaded and nothing more; the window gets its size then. */
const inside = (browser) => {
  const take = async (file, output, width, height, command, options) => {
    const context = await browser.newContext({ viewport: { width: 800, height: 600 } });
    try {
      const page = await context.newPage();
      page.setDefaultTimeout(PATIENCE);
      const session = await context.newCDPSession(page);
      await page.goto(pathToFileURL(resolve(file)).href, { waitUntil: 'load' });
      if (width) await session.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: false });
      const { data } = await session.send(command, options);
      writeFileSync(output, data, 'base64');
      return Buffer.from(data, 'base64');
    } finally {
      await context.close();
    }
  };
  return {
    screenshot: (file, output, width, height) => take(file, output, width, height, 'Page.captureScreenshot', { format: 'png' }),
    print: (file, output) => take(file, output, 0, 0, 'Page.printToPDF', { printBackground: true, preferCSSPageSize: true }),
  };
};

/** How many pictures a PDF holds, and how often it sets the colour of lines to one that is neither white nor grey. */
function picturesAndCurves(pdf) {
  const text = pdf.toString('latin1');
  let count = text.match(/\/Subtype ?\/Image/g)?.length ?? 0;
  for (const { index, 0: head } of text.matchAll(/stream\r?\n/g)) {
    if (text.slice(index - 3, index) === 'end') continue;
    let content = '';
    try {
      content = inflateSync(pdf.subarray(index + head.length)).toString('latin1');
    } catch { /* no page: a font or a picture */ }
    for (const [, ...rgb] of content.matchAll(/([\d.]+) ([\d.]+) ([\d.]+) RG/g)) count += Math.max(...rgb) - Math.min(...rgb) > 0.16;
  }
  return count;
}

/** On a phone, whose narrow window comes after the first drawing, nothing stands out of the cards. */
async function lookAtPhone(page, file, picture, check, taker) {
  const height = 2400;
  await page.setViewportSize({ width: PHONE, height });
  const right = await page.evaluate(() => Math.max(...[...document.querySelectorAll('.figure')].map((figure) => figure.getBoundingClientRect().right)));
  const png = await taker.screenshot(file, picture, PHONE, height);
  const x = Math.ceil(right) + 1;
  const [{ inked }] = await countPixels(page, [png], [{ x, y: 0, width: PHONE - x, height }]);
  check('plain screenshot of a phone: all is inside the cards', inked === 0, `${inked} inked pixels beside them`);
}

/** Every figure of the page, open in `page`, shows its curves in a plain screenshot; `expected`: whether it has any; `browser`: takes the
 * pictures in place of a chromium for each. */
export async function lookPlainly(page, file, expected, check, keep, browser) {
  const taker = browser ? inside(browser) : commands;
  await page.setViewportSize({ width: 1280, height: 800 });
  const tall = Math.min(TALLEST, await page.evaluate(() => document.documentElement.scrollHeight));
  await page.setViewportSize({ width: 1280, height: tall });
  await page.waitForTimeout(250);
  await page.evaluate(() => scrollTo(0, 0));  // a page taller than the picture is where the other checks left it
  const figures = (await page.evaluate(() => [...document.querySelectorAll('[data-block]')].map((block) => {
    const box = block.querySelector('.drawing')?.getBoundingClientRect();
    return box ? { title: block.querySelector('.title').textContent, box: { x: box.x, y: box.y, width: box.width, height: box.height } } : null;
  }))).map((figure, i) => ({ ...figure, expected: expected[i] }))
    .filter(({ box, expected }) => expected && box && box.y + box.height <= tall);
  const folder = mkdtempSync(join(tmpdir(), 'hamel-plain-'));
  try {
    const picture = keep ?? join(folder, 'page.png');
    const png = await taker.screenshot(file, picture, 1280, tall);
    const found = await countPixels(page, [png], figures.map(({ box }) => box));
    figures.forEach(({ title }, i) => check(`plain screenshot: ${title} shows curves`, found[i].colours > 20, `${found[i].colours} coloured pixels`));
    await lookAtPhone(page, file, join(folder, 'phone.png'), check, taker);
    const pdf = join(folder, 'page.pdf');
    const strokes = picturesAndCurves(await taker.print(file, pdf));
    check('plain print: the curves of the figures', strokes >= figures.length, `${strokes} pictures and coloured lines in ${figures.length} figures`);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}
