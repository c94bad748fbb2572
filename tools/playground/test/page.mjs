// node page.mjs BUILD: the playground in headless Chromium, as files behind a server and as one file from disk: first motion, an edit, a
// mistake at its line, a slider, a shared address, every system in turn, the segway balanced by its keys, a cart driven, a phone's width, a file of `hamel live`.
// Leaves pictures in BUILD/playground/looks. Exit status: 0 passed, 1 failed, 77 where the playground or a browser is missing.

import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { askCommands } from './ask_commands.mjs';
import { balance, driveByHand } from './drive_page.mjs';
import { address, after, browser, build, carryOut, CART, check, command, complete, drawings, isMistaken, looks, open, PATIENCE, site, write } from './visit.mjs';

const LITTLE = 1000000;  // bytes, before a server packs them: with what the speed of a line does to them, what the first motion takes

/** The motion of a registered system is there before the library, and goes on when that has run. */
async function lookAtFirst() {
  const page = await (await browser.newContext()).newPage();
  page.setDefaultTimeout(PATIENCE);
  let release = null;
  const held = new Promise((resolve) => { release = resolve; });
  await page.route('**/hamel.wasm', async (route) => {
    await held;
    await route.continue();
  });
  const bytes = [];  // that it waits for
  const weigh = (response) => { if (!/worker\.js|hamel\.wasm/.test(response.url())) bytes.push(response.body().then(({ length }) => length)); };
  page.on('response', weigh);
  await page.goto(`${address}#segway`, { waitUntil: 'commit' });
  await page.waitForSelector('html[data-first]', { state: 'attached' });
  page.off('response', weigh);
  const needed = (await Promise.all(bytes)).reduce((sum, more) => sum + more, 0);
  console.log(`${Math.round(needed / 1000)} kB before the first motion`);
  check('it waits for little', needed < LITTLE, `${needed} bytes`);
  const stage = await page.$('#motion .stage3d');
  check('a motion without the library', stage && !(await page.getAttribute('html', 'data-ready')));
  check('it is that of the address', /chassis|body|segway/i.test(await stage.getAttribute('aria-label')), await stage.getAttribute('aria-label'));
  check('with its text', /segway/.test(await page.textContent('#text')), await page.textContent('#text'));
  release();
  await page.waitForSelector('html[data-ready=true]', { state: 'attached' });
  check('it goes on when the library has run', await stage.evaluate((element) => element.isConnected));
  await page.context().close();
}

async function lookAtFiles() {
  const page = await open(address);
  console.log(`first motion from a server: ${page.first} ms`);
  check('there is a motion', await page.$('#motion .stage3d'));
  const from = await drawings(page);
  check('it plays', await page.waitForFunction((n) => Number(document.querySelector('#motion .stage3d').dataset.drawings) > n, from + 3).then(() => true, () => false));
  await complete(page);
  check('the page has no mistake', !(await isMistaken(page)), await page.textContent('#mistakes'));
  await page.waitForSelector('#figures figure');
  await page.screenshot({ path: join(looks, 'first.png') });

  await after(page, () => write(page, CART));
  check('an edit runs', !(await isMistaken(page)), await page.textContent('#mistakes'));
  check('its bodies are there', /cart, trailer/.test(await page.getAttribute('#motion .stage3d', 'aria-label')));
  check('its command', (await command(page)) === 'hamel run cart_and_trailer.toml', await command(page));

  await after(page, () => write(page, CART.replace('"hinge"', '"hinje"')));
  check('a mistake is one', await isMistaken(page));
  check('it is at its line', /^line 8\b/.test(await page.textContent('#mistakes li')), await page.textContent('#mistakes'));
  check('it is underlined', await page.$('.cm-line .cm-lintRange-error'));
  check('the old motion is grey', Number(await page.$eval('#motion', (e) => getComputedStyle(e).opacity)) < 0.99 && await page.$('#motion .stage3d'));
  await page.waitForTimeout(400);
  await page.screenshot({ path: join(looks, 'mistake.png') });
  await after(page, () => write(page, 'name = "x"\nbody = [\n'));
  check('what is no TOML has a line, too', /^line \d/.test(await page.textContent('#mistakes li')), await page.textContent('#mistakes'));
  await after(page, () => write(page, CART));
  check('and back', !(await isMistaken(page)));

  await after(page, () => page.fill('[data-name="hitch.torque"] .exact, [data-name="until"] .exact', '7').then(() => page.keyboard.press('Tab')));
  const bar = page.locator('[data-name="until"] input[type=range]');
  await after(page, () => bar.fill('100'));
  check('a slider goes to the command', /--until [\d.]+/.test(await command(page)), await command(page));
  check('and can be taken back', await page.isVisible('[data-name="until"] .back'));

  await page.evaluate(() => { navigator.clipboard.writeText = async (text) => { globalThis.copied = text; }; });
  await page.click('#python');
  const python = await page.evaluate(() => globalThis.copied);
  check('the same in Python', /hamel\.run\(r'''\nname = "cart_and_trailer"[^]*until=[\d.]+/.test(python), python);

  const shared = await open(page.url());
  await complete(shared);
  check('a shared address has the text', /cart_and_trailer/.test(await shared.textContent('.cm-content')));
  check('and the slider', (await command(shared)) === (await command(page)), await command(shared));
  await shared.context().close();
  const damaged = await open(`${address}#~damaged`);
  await complete(damaged);
  check('a damaged address is reported', /damaged/.test(await damaged.textContent('#mistakes')) || await damaged.$('#motion .stage3d'));
  await damaged.context().close();

  const names = await page.$$eval('#system option[value]', (options) => options.map((o) => o.value).filter(Boolean));
  check('all systems are in the list', names.length >= 25, String(names.length));
  for (const name of names) {
    await after(page, () => page.selectOption('#system', name));
    check(`${name} runs`, !(await isMistaken(page)), await page.textContent('#mistakes'));
    check(`${name} has its command`, (await command(page)) === `hamel run ${name}`, await command(page));
  }
  await after(page, () => page.selectOption('#system', 'bicycle'));
  await page.waitForTimeout(1500);
  check('behind all of them WebGL draws', await page.$('#motion canvas'));
  await page.context().close();
}

async function lookElsewhere() {
  const one = await open(pathToFileURL(join(site, 'playground.html')).href);
  console.log(`first motion of the one file from disk: ${one.first} ms`);
  await complete(one);
  check('the one file runs from disk', await one.$('#motion .stage3d') && !(await isMistaken(one)));
  await one.context().close();

  const fromDisk = await open(`${pathToFileURL(join(site, 'index.html')).href}#segway`);
  await complete(fromDisk);
  check('from disk the one file takes over', /playground\.html#segway$/.test(fromDisk.url()) && /segway/.test(await command(fromDisk)), fromDisk.url());
  await fromDisk.context().close();

  const phone = await open(`${address}#suslov`, { viewport: { width: 390, height: 800 }, isMobile: true, hasTouch: true });
  await complete(phone);
  await phone.waitForSelector('#figures figure');
  check('a phone shows no more than its width', await phone.evaluate(() => document.documentElement.scrollWidth <= innerWidth), String(await phone.evaluate(() => document.documentElement.scrollWidth)));
  check('the motion is first', (await phone.locator('#motion').boundingBox()).y < (await phone.locator('#editor').boundingBox()).y);
  await phone.screenshot({ path: join(looks, 'phone.png'), fullPage: true });
  await phone.context().close();

  const dark = await open(`${address}#rolling_disk`, { colorScheme: 'dark' });
  await complete(dark);
  await dark.waitForSelector('#figures figure');
  await dark.waitForTimeout(1000);
  await dark.screenshot({ path: join(looks, 'dark.png'), fullPage: true });
  await dark.context().close();
}

/** `hamel live` with options of a run. */
async function lookAtLive() {
  const file = join(looks, 'live.html');
  execFileSync(join(build, 'tools/hamel'), ['live', 'segway', '--until', '3', '--velocity', '0,1,0,4,4,0', '--no-open', '-o', file],
    { env: { ...process.env, HAMEL_PLAYGROUND: join(site, 'playground.html') } });
  const page = await open(pathToFileURL(file).href);
  await complete(page);
  check('live has the options of its run', (await command(page)) === 'hamel run segway --until 3 --velocity 0,1,0,4,4,0', await command(page));
  check('and runs with them', !(await isMistaken(page)), await page.textContent('#mistakes'));
  await after(page, () => page.click('[data-name="velocity"] .back'));
  check('one without a slider can be taken back', (await command(page)) === 'hamel run segway --until 3', await command(page));
  await page.context().close();
  const text = readFileSync(file, 'utf8');
  check('the page does not wait until the module is read', text.indexOf('id="module"') > text.lastIndexOf('<script>'));
}

process.exit(await carryOut(lookAtFirst, lookAtFiles, balance, driveByHand, askCommands, lookElsewhere, lookAtLive));
