// Commands of the program in the page: lines that are typed, a text that is an ensemble.

import { join } from 'node:path';
import { address, after, CART, check, command, complete, isMistaken, looks, open, write } from './visit.mjs';

const TURNS = `system = "chaplygin_sleigh"
until = 5
grid = true
keep = ["end.theta"]
[vary]
start.omega = { range = [-3, 3, 4] }
start.v1 = { range = [-1.5, 1.5, 3] }
`;

/** Other commands: a line that is typed, a text that is an ensemble. */
export async function askCommands() {
  const page = await open(`${address}#bicycle`);
  await complete(page);
  const ask = async (line) => {
    const before = await page.getAttribute('#printed', 'data-commands');
    await page.fill('#words', line);
    await page.keyboard.press('Enter');
    await page.waitForFunction((was) => document.getElementById('printed').dataset.commands !== was, before ?? undefined);
    return page.textContent('#printed');
  };
  const offers = await page.$$eval('#offers option', (options) => options.map(({ value }) => value));
  check('commands are offered', offers.some((offer) => /^steady bicycle --vary speed=/.test(offer)), offers.join('; '));
  check('an analysis', /nonholonomic/.test(await ask('describe bicycle --analyse')), await page.textContent('#printed'));
  check('eigenvalues along the speed', /weave|stable/i.test(await ask(offers.find((offer) => /^steady/.test(offer)))), await page.textContent('#printed'));
  await page.waitForSelector('#figures[data-drawn=true] figure');
  check('with their page', /Eigenvalues|eigenvalue/.test(await page.textContent('#figures')), await page.textContent('#figures'));
  await page.screenshot({ path: join(looks, 'steady.png'), fullPage: true });
  check('a mistake is said', /bicycle/.test(await ask('describe bicylce')), await page.textContent('#printed'));

  await after(page, () => write(page, TURNS));
  check('an ensemble runs', !(await isMistaken(page)) && (await command(page)) === 'hamel ensemble chaplygin_sleigh_ensemble.toml', `${await page.textContent('#mistakes')} ${await command(page)}`);
  await page.waitForSelector('#figures[data-drawn=true] .heatmap');
  await page.screenshot({ path: join(looks, 'ensemble.png'), fullPage: true });
  await after(page, () => write(page, TURNS.replace('grid', 'gird')));
  check('its mistake is at its line', /^line 3\b/.test(await page.textContent('#mistakes li')), await page.textContent('#mistakes'));
  await after(page, () => write(page, CART));
  check('and a system moves again', await page.$('#motion .stage3d') && !(await isMistaken(page)));
  await page.context().close();
}
