// Uses what is turned the way a reader does: every animation plays, stops, is scrubbed, turned and reset; the sphere is turned.

import { differences } from './pixels.mjs';

/** Of each animation, in the page: where on its bar, from 0 to 1, its forces are strongest; null where it has none to show. */
function strongestAt() {
  const { sections } = JSON.parse(document.getElementById('hamel-data').textContent);
  return sections.flatMap((section) => section.blocks ?? []).filter(({ kind }) => kind === 'animation').map(({ times, forces = [] }) => {
    const sizes = times.map((_, i) => Math.max(0, ...forces.map(({ values }) => Math.hypot(...(values[i]?.slice(3) ?? [])))));
    const most = Math.max(...sizes);
    return most > 0 ? (times[sizes.indexOf(most)] - times[0]) / (times.at(-1) - times[0]) : null;
  });
}

/** Of each animation, in the page: does any of its bodies move? A robot may rest. */
function moving() {
  const { sections } = JSON.parse(document.getElementById('hamel-data').textContent);
  return sections.flatMap((section) => section.blocks ?? []).filter(({ kind }) => kind === 'animation')
    .map(({ bodies }) => bodies.some(({ poses }) => poses.some((pose) => JSON.stringify(pose) !== JSON.stringify(poses[0]))));
}

/** A tenth of the speed, so that a busy machine does not come to the end before it is told to pause. */
async function slowDown(speed) {
  const now = Number(await speed.inputValue());
  const all = await speed.locator('option').evaluateAll((options) => options.map(({ value }) => Number(value)));
  await speed.selectOption(String(Math.max(all[0], ...all.filter((s) => s <= now / 10))));
}

export async function useAnimation(page, check) {
  const figures = page.locator('.figure.animation');
  const [pushed, moves] = await figures.count() ? [await page.evaluate(strongestAt), await page.evaluate(moving)] : [[], []];
  for (let n = 0; n < await figures.count(); ++n) {
    const figure = figures.nth(n);
    const title = await figure.locator('.title').textContent();
    const [stage, bar, play] = ['.stage3d', '.bar', '.play'].map((selector) => figure.locator(selector));
    await figure.scrollIntoViewIfNeeded();
    const value = async () => Number(await bar.inputValue());
    const look = () => stage.screenshot();
    const stands = await look();
    await slowDown(figure.getByLabel('speed'));
    const same = (a, b) => a.equals(b);
    check(`${title}: stands still at first`, await value() === 0 && (await play.textContent()).includes('play'));
    await play.click();
    let moved = 0;
    for (let i = 0; i < 60 && moved === 0; ++i) {
      await page.waitForTimeout(50);
      moved = await value();
    }
    check(`${title}: plays`, moved > 0 && (await play.textContent()).includes('pause'), `the bar stands at ${moved}`);
    await play.click();
    const stopped = await value();
    await page.waitForTimeout(200);
    check(`${title}: pauses`, await value() === stopped, `${stopped}, then ${await value()}`);
    const paused = await look();
    await bar.focus();
    await page.keyboard.press('End');
    const [last, clock] = [await look(), await figure.locator('.clock').textContent()];
    check(`${title}: scrubs to the end`, await value() === 1000 && clock !== 't = 0' && !same(last, paused) === moves[n], `${await value()}, ${clock}`);
    const pixels = await differences(page, stands, last);
    check(`${title}: the body has moved`, moves[n] ? pixels > 300 : pixels === 0, `${pixels} differences`);
    await page.keyboard.press('Home');
    check(`${title}: and back to the start`, await differences(page, stands, await look()) < 200);
    const push = figure.getByText('reactions', { exact: true });
    check(`${title}: reactions are there to switch on where the data has forces`, await push.count() === (pushed[n] === null ? 0 : 1));
    if (await push.count()) {
      await bar.fill(String(Math.round(1000 * pushed[n])));
      const without = await look();
      await push.click();
      const seen = await differences(page, without, await look());
      check(`${title}: arrows appear`, seen > 60, `${seen} differences`);
      await push.click();
      check(`${title}: and go`, await differences(page, without, await look()) < 60);
      await bar.focus();
      await page.keyboard.press('Home');
    }
    await stage.focus();
    await page.keyboard.press('ArrowLeft');
    const turned = await look();
    check(`${title}: an arrow key turns the view`, !same(turned, stands));
    const { x, y, width, height } = await stage.boundingBox();
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + 60, y + height / 2 - 30, { steps: 3 });
    await page.mouse.up();
    const dragged = await look();
    check(`${title}: dragging turns the view`, !same(dragged, turned));
    await page.keyboard.press('+');
    check(`${title}: plus zooms`, !same(await look(), dragged));
    await figure.locator('.home').click();
    await page.mouse.move(5, 5);
    const back = await differences(page, stands, await look());
    check(`${title}: the view resets`, back < 200, `${back} differences`);
  }
}

export async function useSphere(page, check) {
  const stage = page.locator('.figure.sphere .stage3d').first();
  if (!(await stage.count())) return;
  await stage.scrollIntoViewIfNeeded();
  await stage.focus();
  const before = await stage.screenshot();
  await page.keyboard.press('ArrowLeft');
  check('an arrow key turns the sphere', await differences(page, before, await stage.screenshot()) > 200);
}
