// node page.mjs BUILD: the playground in headless Chromium, as files behind a server and as one file from disk: first motion, an edit, a
// mistake at its line, a slider, a shared address, every system in turn, the segway balanced by its keys, a phone's width. Leaves
// pictures in BUILD/playground/looks. Exit status: 0 passed, 1 failed, 77 where the playground or a browser is missing.

import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { cpus, loadavg } from 'node:os';
import { extname, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const build = resolve(process.argv[2] ?? 'build');
const site = join(build, 'playground/site');
const looks = join(build, 'playground/looks');
if (!existsSync(join(site, 'playground.html'))) {
  console.log(`skipped: no ${site}`);
  process.exit(77);
}
const { launch, PATIENCE } = await import(pathToFileURL(join(build, 'playground/tools/report/test/browser.mjs')));
mkdirSync(looks, { recursive: true });

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };
const server = createServer((request, response) => {
  const file = join(site, new URL(request.url, 'http://x').pathname.replace(/\/$/, '/index.html'));
  if (!existsSync(file)) return response.writeHead(404).end();
  response.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'text/plain' }).end(readFileSync(file));
});
await new Promise((done) => { server.listen(0, '127.0.0.1', done); });
const address = `http://127.0.0.1:${server.address().port}/`;

let [passed, failed, at] = [0, 0, 'the beginning'];
function check(what, good, more = '') {
  at = what;
  if (good) ++passed; else ++failed;
  if (!good) console.log(`FAILED: ${what}${more ? `: ${more}` : ''}`);
}

const browser = await launch();
const complaints = [];
async function open(url, options = {}) {
  const page = await (await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options })).newPage();
  page.setDefaultTimeout(PATIENCE);
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type()) && !/GPU stall|Context Lost|CONTEXT_LOST/i.test(message.text())) complaints.push(`${url.slice(0, 60)}: ${message.text()}`);
  });
  page.on('pageerror', (error) => complaints.push(`${url.slice(0, 60)}: ${error.message}`));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url()) && !request.url().startsWith(address)) complaints.push(`a request to ${request.url()}`);
  });
  await page.goto(url);
  await page.waitForSelector('html[data-ready=true]', { state: 'attached' });
  page.first = Number(await page.getAttribute('html', 'data-first'));  // milliseconds from the navigation to the first picture
  return page;
}
const complete = (page) => page.waitForSelector('html[data-complete=true]', { state: 'attached' });
const runs = (page) => page.evaluate(() => Number(document.body.dataset.runs ?? 0));
/** Does something, and waits for the run that follows. */
async function after(page, act) {
  const before = await runs(page);
  await act();
  await page.waitForFunction((n) => Number(document.body.dataset.runs ?? 0) > n, before);
}
const drawings = (page) => page.evaluate(() => Number(document.querySelector('#motion .stage3d')?.dataset.drawings ?? 0));
const isMistaken = (page) => page.evaluate(() => document.body.classList.contains('mistaken'));
const command = (page) => page.textContent('#command');
async function write(page, text) {
  await page.click('.cm-content');
  await page.keyboard.press('Control+A');
  await page.keyboard.insertText(text);
}

const CART = `name = "cart_and_trailer"
body = [
  { name = "cart", mass = 10, at = [0, 0, 0.1], box = [0.5, 0.3, 0.1] },
  { name = "trailer", mass = 5, at = [-1.3, 0, 0.1], box = [0.4, 0.3, 0.1] },
]
joint = [
  { name = "floor", kind = "planar", child = "cart" },
  { name = "hitch", kind = "hinge", parent = "cart", child = "trailer", at = [-0.35, 0, 0.1], damping = 0.5 },
]
blade = [
  { name = "cart axle", body = "cart", at = [0, 0, 0] },
  { name = "trailer axle", body = "trailer", at = [-1.3, 0, 0] },
]
motor = [{ joint = "hitch" }]
[start]
v1 = 1
hitch.angle = 0.8
`;

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
  await page.goto(`${address}#segway`, { waitUntil: 'commit' });
  await page.waitForSelector('html[data-first]', { state: 'attached' });
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
  console.log(`first motion from a server: ${page.first} ms at a load of ${loadavg()[0].toFixed(1)}`);
  check('it is there within 1.2 s', page.first <= 1200 || loadavg()[0] > cpus().length / 2, `${page.first} ms`);
  check('there is a motion', await page.$('#motion .stage3d'));
  const [from, since] = [await drawings(page), Date.now()];
  await page.waitForTimeout(1000);
  console.log(`${((1e3 * ((await drawings(page)) - from)) / (Date.now() - since)).toFixed(0)} pictures a second (software WebGL)`);
  check('it plays', (await drawings(page)) > from + 3);
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

/**
 * The keyboard alone: both motors forwards or backwards, or none, by the sign of the feedback of tests/examples/segway_feedback.cpp.
 * Ten seconds of its motion, which lasts longer where the pictures are slow.
 */
async function balance() {
  const page = await open(`${address}#segway`);
  await complete(page);
  await page.click('#drive');
  await page.waitForSelector('.drive[data-state]');
  await page.screenshot({ path: join(looks, 'drive.png') });
  const state = () => page.evaluate(() => ({ ...JSON.parse(document.querySelector('.drive')?.dataset.state ?? '{}') }));
  let [key, most, time] = [null, 0, 0];
  const begun = Date.now();
  while (time < 10 && Date.now() - begun < PATIENCE) {
    const now = await state();
    if (now.pitch === undefined) break;
    time = now.t;
    most = Math.max(most, Math.abs(now.pitch));
    const torque = 217 * now.pitch + 41 * now["pitch'"] + 7 * (now.v1 - 1);
    const wanted = torque > 8 ? 'ArrowUp' : torque < -8 ? 'ArrowDown' : null;
    if (wanted !== key) {
      if (key) await page.keyboard.up(key);
      if (wanted) await page.keyboard.down(wanted);
      key = wanted;
    }
    await page.waitForTimeout(5);
  }
  console.log(`the segway under the keys: within ${most.toFixed(3)} rad for ${time.toFixed(1)} s, which took ${((Date.now() - begun) / 1000).toFixed(1)} s`);
  check('the segway stays up for 10 s', time >= 10 && most < 0.5, `${most} rad, ${time} s`);
  await page.screenshot({ path: join(looks, 'driven.png') });
  await page.keyboard.press('Escape');
  check('Esc ends it', !(await page.$('.drive')));
  await page.context().close();
}

async function lookElsewhere() {
  const one = await open(pathToFileURL(join(site, 'playground.html')).href);
  console.log(`first motion of the one file from disk: ${one.first} ms`);
  await complete(one);
  check('the one file runs from disk', await one.$('#motion .stage3d') && !(await isMistaken(one)));
  await one.context().close();

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

try {
  await lookAtFirst();
  await lookAtFiles();
  await balance();
  await lookElsewhere();
} catch (error) {
  check(`the script comes to its end, and not behind “${at}”`, false, error.message);
}
complaints.forEach((text) => check('no complaint', false, text));
await browser.close();
server.close();
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
