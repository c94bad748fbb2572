// node look.mjs BUILD: the site in headless Chromium: no page logs an error or is wider than a laptop or a phone; the sleigh
// obeys the equations of `hamel run chaplygin_sleigh`, follows a drag, and does not slide sideways; the search works from disk. Exit status 77 without a
// browser or a site.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const build = resolve(process.argv[2]), html = join(build, 'docs/html');
if (!existsSync(join(html, 'index.html'))) {
  console.log('skipped: tools/docs/build has made no site');
  process.exit(77);
}
let passed = 0, failed = 0;
function expect(condition, what) {
  if (condition) { ++passed; return; }
  ++failed;
  console.log(`FAILED: ${what}`);
}

// ---- the script of the sleigh against the program ----------------------------------------------------
{
  const { step, energy, free } = createRequire(import.meta.url)(join(here, '../static/sleigh.js'));
  const seconds = 6, velocity = [0.05, -1.6, 0];
  const record = JSON.parse(execFileSync(join(build, 'tools/hamel'), ['run', 'chaplygin_sleigh', '--velocity', velocity.join(','),
    '--set', 'mass=1', '--set', 'inertia=1', '--set', 'offset=0.5', '--until', String(seconds), '--rtol', '1e-12', '--json']));
  let state = { x: 0, y: 0, theta: 0, v: velocity[1], u: 0, omega: velocity[0] };
  const begin = energy(state);
  for (let i = 0; i < 1000 * seconds; ++i) state = step(state, 0.001, true, free);
  const [theta, x, y] = record.final.configuration, [omega, v] = record.final.velocity;
  const error = Math.max(...[[theta, state.theta], [x, state.x], [y, state.y], [omega, state.omega], [v, state.v]].map(([a, b]) => Math.abs(a - b)));
  expect(error < 1e-9, `the sleigh's script is ${error} from hamel run chaplygin_sleigh`);
  expect(Math.abs(energy(state) - begin) < 1e-10, 'the energy of the sleigh changes');
  let loose = { x: 0, y: 0, theta: 0, v: 1, u: 0.3, omega: 2 };
  const before = energy(loose);
  for (let i = 0; i < 3000; ++i) loose = step(loose, 0.001, false, free);
  expect(Math.abs(energy(loose) - before) < 1e-9 && Math.abs(loose.omega - 2) < 1e-9, 'without its blade it is no free body');
}

const { launch } = await import(pathToFileURL(join(build, 'tools/report/test/browser.mjs')));
const browser = await launch();
const served = join('playground', 'index.html');  // fetches its module from a server; playground/page looks at it
const pages = readdirSync(html, { recursive: true }).filter((name) => name.endsWith('.html') && name !== served).sort();

// ---- every page ------------------------------------------------------------------------------------
async function visit(name, options) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  const said = [];
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) said.push(message.text()); });
  page.on('pageerror', (error) => said.push(String(error)));
  page.on('request', (request) => { if (!/^(file|data|blob):/.test(request.url())) said.push(`requests ${request.url()}`); });
  await page.goto(pathToFileURL(html).href + '/' + name);
  return { page, context, said };
}
const sizes = { laptop: { viewport: { width: 1366, height: 900 } }, phone: { viewport: { width: 390, height: 844 }, colorScheme: 'dark' } };
for (const [size, options] of Object.entries(sizes)) {
  const { page, context, said } = await visit('index.html', options);
  for (const name of pages) {
    await page.goto(pathToFileURL(join(html, name)).href);
    expect(said.length === 0, `${name}, ${size}: ${said[0]}`);
    said.length = 0;
    const over = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    expect(over <= 0, `${name}, ${size}: ${over} pixels wider than the window`);
  }
  await context.close();
}

// ---- the motions -------------------------------------------------------------------------------------
{
  const { page, context } = await visit('tutorial/nonholonomic.html', { viewport: { width: 1366, height: 900 }, reducedMotion: 'reduce' });
  const canvas = await page.locator('#sleigh canvas').boundingBox();
  const shown = () => page.locator('#sleigh output').textContent();
  const at = (x, y) => [canvas.x + (x + 4) / 8 * canvas.width, canvas.y + canvas.height / 2 - y / 8 * canvas.width];
  await page.waitForTimeout(200);
  const before = await shown();
  await page.mouse.move(...at(2.4, 1.28));
  await page.mouse.down();
  await page.mouse.move(...at(-1, -1), { steps: 10 });
  await page.waitForTimeout(600);
  const during = await shown();
  await page.mouse.up();
  expect(before !== during, 'the sleigh does not follow a drag');
  expect(/across -?0\.00 m\/s/.test(during), `the sleigh slides across its blade: ${during}`);
  await page.locator('#sleigh [name=blade]').uncheck();
  await page.locator('#sleigh canvas').focus();
  await page.keyboard.press('ArrowLeft');
  await page.waitForTimeout(400);
  const loose = await shown();
  expect(!/across -?0\.00 m\/s/.test(loose), `without its blade it does not slide: ${loose}`);
  await context.close();
}
{
  const { page, context } = await visit('index.html', { viewport: { width: 1366, height: 900 } });
  const picture = async () => (await (await page.$('#played iframe')).contentFrame()).evaluate(() => document.querySelector('canvas').toDataURL());
  await page.waitForTimeout(300);
  const first = await picture();
  await page.waitForTimeout(700);
  expect(first !== await picture(), 'the motion of the front page stands still');
  const printed = (await page.pdf({ format: 'A4' })).toString('latin1').match(/\/Type \/Page\b/g).length;
  expect(printed === 1, `the front page takes ${printed} sheets of paper`);
  await page.goto(pathToFileURL(join(html, 'verification.html')).href);
  const path = page.locator('td code', { hasText: 'benchmarks/forward_dynamics' });
  expect(await path.locator('wbr').count() === 3, 'a path in a table does not break behind its slashes');
  await context.close();
}

{
  const { page, context } = await visit('search.html?q=rattleback', { viewport: { width: 1366, height: 900 } });
  await page.waitForSelector('#search-results li', { timeout: 60000 }).catch(() => {});
  expect(await page.locator('#search-results li').count() > 2, 'the search finds no rattleback from disk');
  await context.close();
}

// ---- pictures to look at -----------------------------------------------------------------------------
const folder = join(build, 'docs/looks');
mkdirSync(folder, { recursive: true });
const looks = ['index.html', 'tutorial/nonholonomic.html', 'gallery.html', 'reference/command_line.html', 'method.html', 'howto/python.html'];
for (const [size, options] of Object.entries({ laptop: sizes.laptop, phone: sizes.phone, dark: { ...sizes.laptop, colorScheme: 'dark' } })) {
  for (const name of looks) {
    const { page, context } = await visit(name, options);
    await page.waitForTimeout(1500);
    await page.screenshot({ path: join(folder, `${name.replace('/', '_').replace('.html', '')}-${size}.png`) });
    await context.close();
  }
}
await browser.close();
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
