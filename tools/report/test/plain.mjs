// The page as `chromium --headless --screenshot` and `--print-to-pdf` take it: at once, without waiting for anything.

import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { inflateSync } from 'node:zlib';
import { executable } from './browser.mjs';
import { countPixels } from './pixels.mjs';

const PHONE = 390;      // pixels
const TALLEST = 15000;  // pixels of a picture; a longer page is looked at down to there

function chromium(file, output, ...flags) {
  const run = spawnSync(executable(), ['--headless', '--no-sandbox', '--hide-scrollbars', ...flags, pathToFileURL(resolve(file)).href],
    { encoding: 'utf8', timeout: 400000 });
  if (run.status !== 0) throw new Error(`chromium ${flags.join(' ')}: ${run.stderr}`);
  return readFileSync(output);
}

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
async function lookAtPhone(page, file, picture, check) {
  const height = 2400;
  await page.setViewportSize({ width: PHONE, height });
  const right = await page.evaluate(() => Math.max(...[...document.querySelectorAll('.figure')].map((figure) => figure.getBoundingClientRect().right)));
  const png = chromium(file, picture, `--screenshot=${picture}`, `--window-size=${PHONE},${height}`);
  const x = Math.ceil(right) + 1;
  const [{ inked }] = await countPixels(page, [png], [{ x, y: 0, width: PHONE - x, height }]);
  check('plain screenshot of a phone: all is inside the cards', inked === 0, `${inked} inked pixels beside them`);
}

/** Every figure of the page, open in `page`, shows its curves in a plain screenshot; `expected`: whether it has any. */
export async function lookPlainly(page, file, expected, check, keep) {
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
    const png = chromium(file, picture, `--screenshot=${picture}`, `--window-size=1280,${tall}`);
    const found = await countPixels(page, [png], figures.map(({ box }) => box));
    figures.forEach(({ title }, i) => check(`plain screenshot: ${title} shows curves`, found[i].colours > 20, `${found[i].colours} coloured pixels`));
    await lookAtPhone(page, file, join(folder, 'phone.png'), check);
    const pdf = join(folder, 'page.pdf');
    const strokes = picturesAndCurves(chromium(file, pdf, `--print-to-pdf=${pdf}`));
    check('plain print: the curves of the figures', strokes >= figures.length, `${strokes} pictures and coloured lines in ${figures.length} figures`);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}
