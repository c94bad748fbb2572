// What the looks at the playground share: a server, a browser, and what one does with a page. BUILD is the first word of the command line.

import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

export const build = resolve(process.argv[2] ?? 'build');
export const site = join(build, 'playground/site');
export const looks = join(build, 'playground/looks');
if (!existsSync(join(site, 'playground.html'))) {
  console.log(`skipped: no ${site}`);
  process.exit(77);
}
export const { launch, PATIENCE } = await import(pathToFileURL(join(build, 'playground/tools/report/test/browser.mjs')));
mkdirSync(looks, { recursive: true });

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.png': 'image/png', '.svg': 'image/svg+xml', '.woff2': 'font/woff2' };
const server = createServer((request, response) => {  // below /docs the documentation site
  const path = new URL(request.url, 'http://x').pathname.replace(/\/$/, '/index.html');
  const file = path.startsWith('/docs/') ? join(build, 'docs/html', path.slice(5)) : join(site, path);
  if (!existsSync(file)) return response.writeHead(path === '/favicon.ico' ? 204 : 404).end();
  response.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'text/plain' }).end(readFileSync(file));
});
await new Promise((done) => { server.listen(0, '127.0.0.1', done); });
export const address = `http://127.0.0.1:${server.address().port}/`;

let [passed, failed, at] = [0, 0, 'the beginning'];
export function check(what, good, more = '') {
  at = what;
  if (good) ++passed; else ++failed;
  if (!good) console.log(`FAILED: ${what}${more ? `: ${more}` : ''}`);
}

export const browser = await launch();
export const complaints = [];
export async function open(url, { context, ...options } = {}) {
  const page = await (context ?? await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options })).newPage();
  page.setDefaultTimeout(PATIENCE);
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type()) && !/GPU stall|Context Lost|CONTEXT_LOST/i.test(message.text())) complaints.push(`${url.slice(0, 60)}: ${message.text()}`);
  });
  page.on('pageerror', (error) => complaints.push(`${url.slice(0, 60)}: ${error.message}`));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url()) && !request.url().startsWith(address)) complaints.push(`a request to ${request.url()}`);
  });
  await page.goto(url);
  if (!url.startsWith(`${address}docs/`)) await ready(page);
  return page;
}
/** Waits for the first run of the playground. */
export async function ready(page) {
  await page.waitForSelector('html[data-ready=true]', { state: 'attached' });
  page.first = Number(await page.getAttribute('html', 'data-first'));  // milliseconds from the navigation to the first picture
}
export const complete = (page) => page.waitForSelector('html[data-complete=true]', { state: 'attached' });
export const runs = (page) => page.evaluate(() => Number(document.body.dataset.runs ?? 0));
/** Does something, and waits for the run that follows. */
export async function after(page, act) {
  const before = await runs(page);
  await act();
  await page.waitForFunction((n) => Number(document.body.dataset.runs ?? 0) > n, before);
}
export const drawings = (page) => page.evaluate(() => Number(document.querySelector('#motion .stage3d')?.dataset.drawings ?? 0));
export const isMistaken = (page) => page.evaluate(() => document.body.classList.contains('mistaken'));
export const command = (page) => page.textContent('#command');
export async function write(page, text) {
  await page.click('.cm-content');
  await page.keyboard.press('Control+A');
  await page.keyboard.insertText(text);
}

export const CART = `name = "cart_and_trailer"
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

export async function close() {
  await browser.close();
  server.close();
}

/** Runs each look in its turn; the exit status. */
export async function carryOut(...all) {
  try {
    for (const one of all) await one();
  } catch (error) {
    check(`the script comes to its end, and not behind “${at}”`, false, error.message);
  }
  complaints.forEach((text) => check('no complaint', false, text));
  await close();
  console.log(`${passed} passed, ${failed} failed`);
  return failed ? 1 : 0;
}
