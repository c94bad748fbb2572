// Uses every animation the way a reader does: plays, stops, scrubs, turns, resets.

export async function useAnimation(page, check) {
  const figures = page.locator('.figure.animation');
  for (let n = 0; n < await figures.count(); ++n) {
    const figure = figures.nth(n);
    const title = await figure.locator('.title').textContent();
    const [canvas, bar, play] = ['canvas', '.bar', '.play'].map((selector) => figure.locator(selector));
    await figure.scrollIntoViewIfNeeded();
    const value = async () => Number(await bar.inputValue());
    /** The picture once it is painted. */
    const settled = async () => {
      await canvas.and(page.locator('[aria-busy=false]')).waitFor({ timeout: 30000 });
      return canvas.evaluate((element) => element.toDataURL());
    };
    /** How much clearly differs from what the picture was when last asked. */
    const changed = () => canvas.evaluate((element) => {
      const copy = new OffscreenCanvas(element.width, element.height).getContext('2d', { willReadFrequently: true });
      copy.drawImage(element, 0, 0);
      const { data } = copy.getImageData(0, 0, element.width, element.height);
      const before = element.lastPixels ?? [];
      element.lastPixels = data;
      return data.reduce((count, v, i) => count + (i % 4 < 3 && Math.abs(v - before[i]) > 60), 0);
    });
    const stands = await settled();
    await changed();
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
    const paused = await settled();
    check(`${title}: pauses`, await value() === stopped, `${stopped}, then ${await value()}`);
    await bar.focus();
    await page.keyboard.press('End');
    const [last, clock] = [await settled(), await figure.locator('.clock').textContent()];
    check(`${title}: scrubs to the end`, await value() === 1000 && last !== paused && clock !== 't = 0', `${await value()}, ${clock}`);
    const pixels = await changed();
    check(`${title}: the body has moved`, pixels > 5000, `${pixels} differences`);
    await page.keyboard.press('Home');
    check(`${title}: and back to the start`, await settled() === stands);
    await canvas.focus();
    await page.keyboard.press('ArrowLeft');
    const turned = await settled();
    check(`${title}: an arrow key turns the view`, turned !== stands);
    const { x, y, width, height } = await canvas.boundingBox();
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + 60, y + height / 2 - 30, { steps: 3 });
    await page.mouse.up();
    const dragged = await settled();
    check(`${title}: dragging turns the view`, dragged !== turned);
    await page.keyboard.press('+');
    check(`${title}: plus zooms`, await settled() !== dragged);
    await figure.locator('.home').click();
    check(`${title}: the view resets`, await settled() === stands);
  }
}
