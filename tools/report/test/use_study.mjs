// Uses the blocks of a study the way a reader does: reads cells, chooses among filters, types into the table's box.

/** The data of the page's first block that `wanted` (a function's text) accepts. */
const blockOf = (page, wanted) => page.evaluate((source) => {
  const data = JSON.parse(document.getElementById('hamel-data').textContent);
  const accepts = new Function('b', `return ${source}`);
  return data.sections.flatMap((section) => section.blocks ?? []).find(accepts) ?? null;
}, wanted);

/** Every heat map: the keyboard reads the largest and the smallest value, and the larger is the darker cell. */
export async function useHeatmap(page, check) {
  const maps = page.locator('.figure.heatmap .chart');
  const blocks = await page.evaluate(() => JSON.parse(document.getElementById('hamel-data').textContent)
    .sections.flatMap((section) => section.blocks ?? []).filter((block) => block.kind === 'heatmap'));
  for (let n = 0; n < await maps.count(); ++n) {
    const { title, log, values, marks, y_values: ys, classes } = blocks[n];
    const map = maps.nth(n);
    await map.scrollIntoViewIfNeeded();
    await map.focus();
    const upward = ys.every((y) => typeof y === 'number') && ys.at(-1) > ys[0];
    const all = values.flatMap((row, r) => row.map((value, c) => ({ value, c, row: upward ? ys.length - 1 - r : r, mark: marks?.[r][c] })));
    const known = all.filter(({ value }) => typeof value === 'number' && (!log || value > 0)).sort((a, b) => a.value - b.value);
    const at = [0, 0];  // the cell of the keyboard
    const look = async ({ c, row }) => {
      for (const [key, times] of [['ArrowRight', c - at[0]], ['ArrowLeft', at[0] - c], ['ArrowDown', row - at[1]], ['ArrowUp', at[1] - row]]) {
        for (let i = 0; i < times; ++i) await page.keyboard.press(key);
      }
      [at[0], at[1]] = [c, row];
      await page.keyboard.press('ArrowLeft');  // (at the first cell it stays; elsewhere it goes there and back)
      if (c + row > 0) await page.keyboard.press('ArrowRight');
      return map.evaluate((holder, number) => {
        const cells = [...holder.querySelectorAll('svg path')].filter((path) => /^(rgb|url|var\(--(paper|mesh|c\d))/.test(path.getAttribute('fill') ?? ''));
        const fill = cells[number]?.getAttribute('fill') ?? '';
        return { fill, light: (fill.match(/\d+/g) ?? []).reduce((sum, v) => sum + Number(v), 0), tip: holder.parentElement.querySelector('[role=status]').textContent };
      }, row * values[0].length + c);
    };
    if (classes) await lookAtClasses(page, check, n, title, classes, known, look);
    else if (known.length > 1 && known.at(-1).value > known[0].value) {
      const [least, most] = [await look(known[0]), await look(known.at(-1))];
      check(`heat map ${title}: larger is darker`, /rgb/.test(most.fill) && most.light < least.light - 20, `${most.fill} and ${least.fill}`);
      check(`heat map ${title}: the cell is read out`, /\d/.test(most.tip) && most.tip !== least.tip, most.tip);
    }
    const empty = all.find(({ value, mark }) => value === null && !mark);
    if (empty) {
      const { tip, fill } = await look(empty);
      check(`heat map ${title}: an empty cell is hatched and says so`, fill.startsWith('url(') && tip.includes('no value'), `${tip}, ${fill}`);
    }
    const marked = all.find(({ mark }) => mark);
    if (marked) check(`heat map ${title}: a mark is read out`, (await look(marked)).tip.includes(`(${marked.mark})`));
  }
}

/** Each class has a colour, its name in the legend and where its cells are read, and there is no scale of numbers. */
async function lookAtClasses(page, check, n, title, classes, known, look) {
  const seen = classes.flatMap((name, c) => known.filter(({ value }) => value === c).slice(0, 1).map((cell) => ({ name, cell })));
  const fills = [];
  for (const { name, cell } of seen) {
    const { fill, tip } = await look(cell);
    fills.push(fill);
    check(`heat map ${title}: the class ${name} is read out`, tip.includes(name), tip);
  }
  check(`heat map ${title}: a colour for each class`, new Set(fills).size === seen.length && fills.every((fill) => /^var\(--(c\d|mesh)/.test(fill)), String(fills));
  const figure = page.locator('.figure.heatmap').nth(n);
  const [legend, inside] = [await figure.locator('.legend').textContent(), await figure.locator('svg text').allTextContents()];
  check(`heat map ${title}: the legend has all names`, classes.every((name) => legend.includes(name)), legend);
  check(`heat map ${title}: no scale of numbers`, await figure.locator('.chart svg linearGradient').count() === 0, String(inside));
}

/** A plot with filters shows exactly the series of the chosen tags, by keyboard too. */
export async function useFilters(page, check) {
  const block = await blockOf(page, "b.kind === 'plot' && b.filters?.length > 0");
  if (!block) return;
  const figure = page.locator('.figure.plot:has(.filters)').first();
  await figure.scrollIntoViewIfNeeded();
  const entries = () => figure.locator('.legend .entry:visible').count();
  const [{ name, values }] = block.filters;
  const expected = (first) => block.series.filter((s) => block.filters.every((filter, i) => {
    const wanted = i ? filter.values[0] : first;
    return wanted === 'all' || s.tags?.[filter.name] === undefined || s.tags[filter.name] === wanted;
  })).length;
  const ink = () => figure.locator('.chart svg').first().innerHTML();
  check(`filter ${name}: the first value is chosen at the start`, await entries() === expected(values[0]), `${await entries()} series, not ${expected(values[0])}`);
  const before = await ink();
  const select = figure.locator('.filters select').first();
  await select.focus();
  await page.keyboard.press('End');  // “all” stands last
  await page.keyboard.press('Enter');
  await page.waitForTimeout(100);
  check(`filter ${name}: “all” shows all, by keyboard`, await entries() === expected('all'), `${await entries()} series, not ${expected('all')}`);
  check(`filter ${name}: the picture follows`, expected('all') === expected(values[0]) || before !== await ink());
  const fit = block.series.find((s) => s.fit?.text)?.fit.text;
  if (fit) check('a fit is in the legend', (await figure.locator('.legend').textContent()).includes(fit), fit);
}

/** A table with a filter: only rows with the words stay, and the count says how many. */
export async function useTable(page, check) {
  const block = await blockOf(page, "b.kind === 'table' && b.filter && b.rows.length > 0");
  if (!block) return;
  const shown = page.locator('.table-block:has(.count)').first();
  await shown.scrollIntoViewIfNeeded();
  const count = () => shown.locator('.count').textContent();
  const made = await shown.locator('tbody tr').count();
  check('a long table is made in slices', made <= 200, `${made} rows made at once`);
  check('all rows are counted', await count() === `${block.rows.length} of ${block.rows.length} rows`, await count());
  // A word alone: of several, as of “n = 1”, each may stand in another cell.
  const word = block.rows[0].filter((cell) => typeof cell === 'string').flatMap((cell) => cell.split(/\s+/)).find((part) => /[a-z]{3}/i.test(part));
  if (word) {
    await shown.locator('input').fill(word.toUpperCase());
    const rows = await shown.locator('tbody tr').allTextContents();
    const expected = block.rows.filter((row) => row.some((cell) => String(cell).toLowerCase().includes(word.toLowerCase()))).length;
    check('the words filter the rows', await count() === `${expected} of ${block.rows.length} rows` && rows.every((row) => row.toLowerCase().includes(word.toLowerCase())), `“${word}”: ${await count()}, not ${expected}`);
    await shown.locator('input').fill('');
  }
  const select = shown.locator('select').first();
  if (await select.count()) {
    await select.selectOption({ index: 1 });
    const [kept, all] = (await count()).match(/\d+/g).map(Number);
    check('a drop-down filters the rows', kept > 0 && kept < all, await count());
    await select.selectOption({ index: 0 });
  }
  const box = shown.locator('.scroll.tall');
  if (await box.count()) {
    let more = made;
    for (let wait = 0; wait < 50 && more <= made && made < block.rows.length; ++wait) {  // 5 s on a busy machine
      await box.evaluate((element) => { element.scrollTop = element.scrollHeight; });
      await page.waitForTimeout(100);
      more = await shown.locator('tbody tr').count();
    }
    check('scrolling makes more rows', more > made || made === block.rows.length, `${more} rows after ${made}`);
  }
}
