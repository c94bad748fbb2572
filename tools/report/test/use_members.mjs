// Uses the members of an ensemble the way a reader does: by a click on a cell, a point and a dot, by Enter, by a number.

const dataOf = (page) => page.evaluate(() => JSON.parse(document.getElementById('hamel-data').textContent)
  .sections.flatMap((section) => section.blocks ?? []));

/** What the box of the chosen member shows; null where there is none. */
const shown = (page) => page.evaluate(() => {
  const box = document.querySelector('.member');
  return box && { label: box.getAttribute('aria-label'), text: box.textContent, code: box.querySelector('code').textContent, focused: box.contains(document.activeElement),
    rings: [...document.querySelectorAll('.ring:not([hidden])')].length, marks: document.querySelectorAll('.matrix .marked circle').length };
});

/** Every pair of columns of a scatter matrix has a dot for each member with both values, and no cell is empty of its name. */
export async function useScatter(page, check) {
  const blocks = (await dataOf(page)).filter(({ kind }) => kind === 'scatter');
  const figures = page.locator('.figure.scatter');
  for (let n = 0; n < await figures.count(); ++n) {
    const { title, columns } = blocks[n];
    const known = (k, i) => typeof columns[k].values[i] === 'number';
    const pairs = columns.flatMap((_, r) => columns.slice(0, r).map((__, c) => [r, c]));
    const wanted = pairs.reduce((sum, [r, c]) => sum + columns[r].values.filter((_, i) => known(r, i) && known(c, i)).length, 0);
    const drawn = await figures.nth(n).locator('svg path[stroke-linecap=round]').evaluateAll((all) => all.reduce((sum, path) => sum + path.getAttribute('d').split('h0').length - 1, 0));
    check(`${title}: every pair has its dots`, drawn === wanted, `${drawn} dots, not ${wanted}`);
  }
}

export async function useMembers(page, check) {
  const blocks = await dataOf(page);
  const store = blocks.find(({ kind }) => kind === 'members');
  if (!store) return;
  await page.setViewportSize({ width: 1280, height: 900 });
  const close = async () => { if (await page.locator('.member').count()) await page.keyboard.press('Escape'); };
  const isMember = (box, member) => box?.label === `Member ${member}` && box.code === store.command.replace('{}', member);
  const show = async (member) => {
    await page.locator('.pick input').fill(String(member));
    await page.locator('.pick input').press('Enter');
  };

  check('nothing is chosen before', await shown(page) === null);
  // By its number, from the keyboard; what is shown of it.
  const place = (member) => (store.index ? store.index.indexOf(member) : member);
  const known = store.index?.[1] ?? Math.min(1, store.count - 1);
  await show(known);
  let box = await shown(page);
  check('a member is shown by its number, with its command line', isMember(box, known) && box.focused, JSON.stringify(box));
  const wanted = store.columns.filter(({ varied, values }) => (varied || store.failures?.[known] === undefined) && values[place(known)] !== null).map(({ name }) => name);
  check('the box has what is varied and what is kept', wanted.every((name) => box.text.includes(name)), `${box.text} lacks one of ${wanted}`);
  await page.locator('.member button', { hasText: 'copy' }).click();
  const copied = await page.locator('.member .line', { hasText: 'copied' }).waitFor({ timeout: 5000 }).then(() => true, () => false);
  check('its command line is copied', copied);
  await page.locator('.member').focus();
  await close();
  check('Escape closes the box, the focus goes back', await shown(page) === null && await page.locator('.pick input').evaluate((input) => input === document.activeElement));
  const failed = Object.keys(store.failures ?? {})[0];
  if (failed !== undefined) {
    await show(failed);
    box = await shown(page);
    check('of a failed member the reason is shown', box?.text.includes(store.failures[failed]), box?.text);
    await close();
  }
  const moving = Object.keys(store.motions ?? {})[0];
  if (moving !== undefined) {
    await page.locator('.members-block button', { hasText: `member ${moving}` }).click();
    await page.waitForTimeout(300);
    const figure = page.locator('.member .figure').first();
    check('the motion of a member is drawn in its box', await figure.count() === 1 && await figure.locator('canvas, svg').count() > 0);
    const bar = figure.locator('.bar');
    if (await bar.count()) {
      await figure.locator('.play').click();
      let at = 0;
      for (let i = 0; i < 60 && at === 0; ++i) {
        await page.waitForTimeout(50);
        at = Number(await bar.inputValue());
      }
      check('and plays there', at > 0);
      await figure.locator('.play').click();
    }
    await page.setViewportSize({ width: 390, height: 800 });
    await page.waitForTimeout(150);
    const { right, over } = await page.locator('.member').evaluate((element) => ({ right: element.getBoundingClientRect().right, over: element.scrollWidth - element.clientWidth }));
    check('the box fits a phone', right <= 391 && over <= 0, `right ${right}, ${over} pixels too wide`);
    await page.setViewportSize({ width: 1280, height: 900 });
    await close();
  }

  // By a click in the first figure of each kind, and by the keyboard there.
  for (const [kind, has] of [['heatmap', (b) => b.members], ['plot', (b) => b.series.some((s) => s.members?.length > 1)], ['scatter', (b) => b.members]]) {
    const number = blocks.filter((b) => b.kind === kind).findIndex(has);
    if (number < 0) continue;
    const chart = page.locator(`.figure.${kind} .chart`).nth(number);
    await chart.scrollIntoViewIfNeeded();
    await chart.focus();
    await page.keyboard.press('Home');
    await page.keyboard.press('Enter');
    box = await shown(page);
    check(`${kind}: Enter shows the member, the focus goes to it`, box !== null && box.focused, JSON.stringify(box));
    check(`${kind}: the chosen member is marked`, kind === 'scatter' ? box?.marks > 0 : box?.rings > 0, JSON.stringify(box));
    const member = Number(box?.label.split(' ')[1]);
    if (kind === 'heatmap') {
      const { members, y_values: ys } = blocks.filter((b) => b.kind === kind)[number];
      const upward = ys.every((y) => typeof y === 'number') && ys.at(-1) > ys[0];
      const first = members.at(upward ? -1 : 0)[0];
      check('heatmap: the first cell is that member', member === first, `${member}, not ${first}`);
    }
    check(`${kind}: its command line`, isMember(box, member), JSON.stringify(box));
    const at = await chart.evaluate((element, kindOf) => {
      const mark = kindOf === 'scatter' ? element.querySelector('.marked circle') : element.querySelector('.ring:not([hidden])');
      const of = mark?.getBoundingClientRect();
      return of && { x: of.x + of.width / 2, y: of.y + of.height / 2 };
    }, kind);
    await close();
    if (!at) continue;
    await page.mouse.move(at.x, at.y, { steps: 2 });
    await page.mouse.click(at.x, at.y);
    await page.locator('.member').waitFor({ timeout: 3000 }).catch(() => {});
    box = await shown(page);
    check(`${kind}: a click there shows a member, the focus stays`, box !== null && (kind !== 'heatmap' || isMember(box, member)) && !box.focused, `member ${member}: ${JSON.stringify(box)}`);
    if (!box) continue;
    const marks = await chart.locator(kind === 'scatter' ? '.marked circle' : '.ring:not([hidden])').evaluateAll((all) => all.map((mark) => {
      const of = mark.getBoundingClientRect();
      return [of.x + of.width / 2, of.y + of.height / 2];
    }));
    check(`${kind}: the mark is where the click was`, marks.some(([x, y]) => Math.hypot(x - at.x, y - at.y) < 9), `${marks}, not ${at.x},${at.y}`);
    await page.locator('.member .close').click();
    await page.mouse.move(5, 5);
  }
}
