// Uses the charts of curves the way a reader does: zooms, reads by pointer and keyboard, saves.

import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { countPixels } from './pixels.mjs';

export async function useChart(page, check) {
  const figure = page.locator('.figure.plot').first();
  if (!(await figure.count())) return;
  const chart = figure.locator('.chart');
  await chart.scrollIntoViewIfNeeded();
  const { x, y, width, height } = await chart.boundingBox();
  const ticks = () => chart.locator('svg text').allTextContents();
  const before = await ticks();
  await page.mouse.move(x + width * 0.4, y + height * 0.3);
  await page.mouse.down();
  await page.mouse.move(x + width * 0.6, y + height * 0.6, { steps: 4 });
  await page.mouse.up();
  await page.waitForTimeout(100);
  const reset = figure.locator('.reset');
  check('a drag zooms', await reset.isVisible() && String(await ticks()) !== String(before), String(await ticks()));
  check('a zoomed chart has ticks', (await ticks()).length >= 7, String(await ticks()));
  await page.mouse.dblclick(x + width * 0.5, y + height * 0.5);
  await page.waitForTimeout(100);
  check('a double click resets', !(await reset.isVisible()) && String(await ticks()) === String(before), `${await ticks()}, not ${before}`);
  await page.mouse.move(x + width * 0.45, y + height * 0.4, { steps: 2 });
  await page.waitForTimeout(150);
  const tip = figure.locator('.tip');
  const read = await tip.count() ? await tip.textContent() : '';
  const drawable = await chart.evaluate((element) => !/nothing to draw/.test(element.textContent));
  if (drawable) check('the pointer reads the curves', read.includes('='), read);
  await chart.focus();
  await page.keyboard.press('ArrowRight');
  const said = await figure.locator('[role=status]').textContent();
  if (drawable) check('an arrow key reads a point aloud', said.includes('='), said);
  await page.keyboard.press('Escape');
}

/** The buttons of the first figure with curves, and of the first that stands in space: what they save is whole and stands alone. */
export async function useSaving(page, check) {
  for (const kinds of ['.plot, .path, .heatmap', '.animation', '.sphere']) await save(page, check, page.locator(`.figure:is(${kinds})`).first());
}

async function save(page, check, figure) {
  if (!(await figure.count())) return;
  const title = await figure.locator('.title').textContent();
  const folder = mkdtempSync(join(tmpdir(), 'hamel-saved-'));
  const saved = async (name) => {
    const [download] = await Promise.all([page.waitForEvent('download'), figure.locator('.save', { hasText: name }).click()]);
    await download.saveAs(join(folder, name));
    return readFileSync(join(folder, name));
  };
  const svg = (await saved('SVG')).toString();
  check(`${title}: SVG: colours of its own`, /^<svg/.test(svg) && /<path/.test(svg) && !svg.includes('var('), svg.slice(0, 200));
  const png = await saved('PNG');
  const { inked, colours } = png.subarray(1, 4).toString() === 'PNG' ? (await countPixels(page, [png]))[0] : { inked: 0, colours: 0 };
  check(`${title}: PNG: a picture`, inked > 200 && colours > 20, `${png.length} bytes, ${inked} inked and ${colours} coloured pixels`);
  const rows = (await saved('CSV')).toString().trim().split('\n');
  check(`${title}: CSV: a head and rows`, rows.length > 1 && rows[0].startsWith('"'), rows[0]);
  rmSync(folder, { recursive: true });
}
