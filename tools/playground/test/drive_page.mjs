// Runs that are driven: the segway balanced by its keys, a cart under the keyboard, a slider and a gamepad.

import { join } from 'node:path';
import { address, after, browser, check, command, complete, isMistaken, looks, open } from './visit.mjs';

/**
 * Runs in the page: as soon as a run is driven, presses the keys by the sign of the feedback of tests/examples/segway_feedback.cpp, both motors
 * forwards or backwards or none, once a picture. The page presses them itself: a busy machine is then no slower to press than to draw.
 */
function pilot() {
  const flown = globalThis.flown = { most: 0, time: 0 };
  const press = (kind, key) => key && dispatchEvent(new KeyboardEvent(kind, { key, cancelable: true }));
  let key = null;
  new MutationObserver(() => {
    const now = JSON.parse(document.querySelector('.drive')?.dataset.state ?? '{}');
    if (now.pitch === undefined || now.t > 10) return;
    flown.time = now.t;
    flown.most = Math.max(flown.most, Math.abs(now.pitch));
    const torque = 217 * now.pitch + 41 * now["pitch'"] + 7 * (now.v1 - 1);
    const wanted = torque > 8 ? 'ArrowUp' : torque < -8 ? 'ArrowDown' : null;
    if (wanted === key) return;
    press('keyup', key);
    press('keydown', wanted);
    key = wanted;
  }).observe(document.getElementById('motion'), { childList: true, subtree: true, attributeFilter: ['data-state'] });
}

/** Ten seconds of its motion, which lasts longer where the pictures are slow. */
export async function balance() {
  const page = await open(`${address}#segway`);
  await complete(page);
  await page.evaluate(pilot);
  await page.click('#drive');
  await page.waitForSelector('.drive[data-state]');
  await page.screenshot({ path: join(looks, 'drive.png') });
  const begun = Date.now();
  await page.waitForFunction(() => globalThis.flown.time > 9.9 || !document.querySelector('.drive'));
  const { most, time } = await page.evaluate(() => globalThis.flown);
  console.log(`the segway under the keys: within ${most.toFixed(3)} rad for ${time.toFixed(1)} s, which took ${((Date.now() - begun) / 1000).toFixed(1)} s`);
  check('the segway stays up for 10 s', time > 9.9 && most < 0.5, `${most} rad, ${time} s`);
  await page.screenshot({ path: join(looks, 'driven.png') });
  await page.keyboard.press('Escape');
  check('Esc ends it', !(await page.$('.drive')));
  await page.context().close();
}

/** A cart that cannot fall, under the keyboard, a slider and a gamepad. */
export async function driveByHand() {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 } });
  await context.addInitScript(() => { navigator.getGamepads = () => [null, ...(globalThis.stick ? [{ axes: globalThis.stick }] : [])]; });
  const page = await open(`${address}#differential_drive`, { context });
  await complete(page);
  await page.click('#drive');
  await page.waitForSelector('.drive[data-state]');
  const speed = () => page.evaluate(() => JSON.parse(document.querySelector('.drive').dataset.state).v1);
  /** Does the speed leave this range, above or below? */
  const leaves = (low, high) => page.waitForFunction(([from, to]) => {
    const { v1 } = JSON.parse(document.querySelector('.drive').dataset.state);
    return v1 < from || v1 > to;
  }, [low, high]).then(() => true, () => false);
  const atFirst = await speed();
  await page.keyboard.down('ArrowUp');
  check('a key drives', await leaves(-1e9, atFirst + 0.2));
  check('its button is pressed', await page.$('.drive [aria-pressed=true]'));
  await page.keyboard.up('ArrowUp');
  check('it is let go', !(await page.$('.drive [aria-pressed=true]')));
  await page.evaluate(() => { globalThis.stick = [0.05, 1, 0, 0]; });
  check('a stick pulled back brakes', await leaves(await speed() - 0.2, 1e9));
  await page.evaluate(() => { globalThis.stick = null; });
  const now = await speed();
  await page.fill('[data-name="left_torque"] .exact', '3').then(() => page.keyboard.press('Tab'));
  check('a slider moves its input', await leaves(now - 0.2, now + 0.2));
  check('and goes to the command', /left_torque=3/.test(await command(page)), await command(page));
  await after(page, () => page.click('.drive .stop'));
  check('the run has it then', !(await page.$('.drive')) && !(await isMistaken(page)), await page.textContent('#mistakes'));
  await context.close();
}
