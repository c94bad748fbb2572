// node walks.mjs BUILD: three newcomers on the documentation site, from its front page to something that moves and to something of their own that
// moves, without installing anything. Each reads what stands above the place where the next click is (200 words a minute) and types what is
// not there (150 characters a minute): at most 1 and 5 minutes. Exit status: 0 passed, 1 failed, 77 where the site, the playground or a
// browser is missing.

import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { address, after, build, carryOut, check, command, complete, isMistaken, looks, open, ready } from './visit.mjs';

if (!existsSync(join(build, 'docs/html/playground/index.html'))) {
  console.log(`skipped: no playground in ${build}/docs/html`);
  process.exit(77);
}
const [WORDS, CHARACTERS] = [200, 150];  // a minute
const [FIRST, OWN] = [1, 5];             // minutes

/** One who reads and types: the minutes so far, of reading and typing by their counts, of waiting by the clock. */
class Newcomer {
  constructor(who, page) {
    Object.assign(this, { who, page, minutes: 0, waited: 0, said: [] });
  }

  /** Reads the article down to the element, which is then clicked. */
  async readTo(selector) {
    const target = this.page.locator(selector).first();
    const words = await target.evaluate((end) => {
      const range = document.createRange();
      range.setStart(document.querySelector('article') ?? document.body, 0);
      range.setEndBefore(end);
      return range.toString().split(/\s+/).filter((word) => /\w/.test(word)).length;
    });
    this.minutes += words / WORDS;
    this.said.push(`${words} words`);
    return target;
  }

  async click(target, wait) {
    const begun = Date.now();
    await target.click();
    await wait();
    this.waited += Date.now() - begun;
  }

  async type(act, text) {
    this.minutes += text.length / CHARACTERS;
    this.said.push(`${text.length} characters`);
    await after(this.page, act);
  }

  tell(what, most) {
    console.log(`${this.who}: ${what} after ${this.minutes.toFixed(1)} min (${this.said.join(', ')}), and ${(this.waited / 1000).toFixed(1)} s of waiting`);
    check(`${this.who}: ${what} within ${most} min`, this.minutes <= most, `${this.minutes} min`);
  }
}

const inPlayground = async (page) => {
  await page.waitForSelector('html[data-first]', { state: 'attached' });
};
async function begin(who) {
  const page = await open(`${address}docs/index.html`);
  return new Newcomer(who, page);
}
/** From the front page to the first motion. */
async function firstMotion(newcomer) {
  await newcomer.click(await newcomer.readTo('.try.first a'), () => inPlayground(newcomer.page));
  newcomer.tell('a first motion', FIRST);
  await newcomer.page.goBack();
}
async function finish({ who, page }) {
  await ready(page);
  await complete(page);
  check(`${who}: it is no mistake`, !(await isMistaken(page)), await page.textContent('#mistakes'));
  await page.screenshot({ path: join(looks, `walk_${who.split(' ')[0]}.png`) });
  await page.context().close();
}

/** Wants a system by its formulas: inertia and constraint of a sleigh, then what is known of it. */
async function researcher() {
  const one = await begin('researcher');
  const { page } = one;
  await firstMotion(one);
  await one.click(page.locator('.sidebar-tree a', { hasText: 'A system of your own' }).first(), () => page.waitForSelector('h1:has-text("A system of your own")'));
  await one.click(await one.readTo('.try a'), () => inPlayground(page));
  await complete(page);
  const text = 'J*2 + m*a^2';
  await one.type(async () => {
    await page.click('.cm-line:has-text("inertia") >> nth=0');
    await page.keyboard.press('Home');
    await page.keyboard.press('Shift+End');
    await page.keyboard.insertText(`inertia = [["${text}", 0, "m*a"], [0, "m", 0], ["m*a", 0, "m"]]`);
  }, text);
  one.tell('a system of their own moves', OWN);
  await page.fill('#words', await page.locator('#offers option').first().getAttribute('value'));
  await page.keyboard.press('Enter');
  await page.waitForSelector('#printed[data-commands]');
  check('researcher: it is analysed', /nonholonomic: brackets/.test(await page.textContent('#printed')), await page.textContent('#printed'));
  await finish(one);
}

/** Wants a vehicle with a trailer, a motor, and the line that does the same on a robot's computer. */
async function engineer() {
  const one = await begin('engineer of robots');
  const { page } = one;
  await firstMotion(one);
  await one.click(await one.readTo('article a:has-text("ten minutes")'), () => page.waitForSelector('h1:has-text("ten minutes")'));
  await one.click(await one.readTo('.try a >> nth=-1'), () => inPlayground(page));
  await complete(page);
  const line = '  { name = "box", mass = 3, at = [-1.3, 0, 0.3], box = [0.3, 0.2, 0.2] },\n';
  await one.type(async () => {
    await page.click('.cm-line:has-text("trailer\\", mass")');
    await page.keyboard.press('Home');
    await page.keyboard.insertText(line);
    await page.click('.cm-line:has-text("hitch\\", kind")');
    await page.keyboard.press('Home');
    await page.keyboard.insertText('  { name = "on", kind = "weld", parent = "trailer", child = "box", at = [-1.3, 0, 0.2] },\n');
  }, `${line}  { name = "on", kind = "weld", parent = "trailer", child = "box", at = [-1.3, 0, 0.2] },\n`);
  one.tell('a mechanism of their own moves', OWN);
  check('engineer of robots: the command is there', (await command(page)) === 'hamel run cart_and_trailer.toml', await command(page));
  await finish(one);
}

/** Wants something to drag for a class, and an address that has an experiment of theirs. */
async function teacher() {
  const one = await begin('teacher');
  const { page } = one;
  await firstMotion(one);
  await one.click(await one.readTo('.try.first a[href*=rattleback]'), () => inPlayground(page));
  await complete(page);
  await one.type(() => page.fill('[data-name="until"] .exact', '60').then(() => page.keyboard.press('Tab')), '60');
  one.tell('an experiment of their own moves', OWN);
  await page.evaluate(() => { navigator.clipboard.writeText = async (text) => { globalThis.copied = text; }; });
  await page.click('#share');
  const shared = await open(await page.evaluate(() => globalThis.copied));
  await complete(shared);
  check('teacher: the class sees the same', (await command(shared)) === 'hamel run rattleback --until 60', await command(shared));
  await shared.context().close();
  await finish(one);
}

process.exit(await carryOut(researcher, engineer, teacher));
