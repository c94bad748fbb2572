// One page in a running browser: everything that a reader can do with it, and whether it is as it should be.

import { readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { PATIENCE } from './browser.mjs';
import { lookPlainly } from './plain.mjs';
import { countPixels } from './pixels.mjs';
import { misfit } from './schema.mjs';
import { useAnimation, useSphere } from './use_animation.mjs';
import { useChart, useSaving } from './use_chart.mjs';
import { useMembers, useScatter } from './use_members.mjs';
import { useFilters, useHeatmap, useTable } from './use_study.mjs';

/** Runs in the page before anything else: a browser without WebGL. */
function takeWebglAway() {
  for (const kind of [HTMLCanvasElement, OffscreenCanvas]) {
    const original = kind.prototype.getContext;
    kind.prototype.getContext = function getContext(name, ...rest) {
      return /webgl|webgpu/.test(name) ? null : original.call(this, name, ...rest);
    };
  }
}

const STALL = /GPU stall due to ReadPixels/;  // by software WebGL, where a screenshot is taken

/** Opens the page and collects what it should not do. */
async function open(browser, file, { webgl = true } = {}) {
  const page = await (await browser.newContext({ viewport: { width: 1280, height: 800 } })).newPage();
  page.setDefaultTimeout(PATIENCE);
  if (!webgl) await page.addInitScript(takeWebglAway);
  const complaints = [];
  page.on('console', (message) => {
    if (['error', 'warning', 'assert'].includes(message.type()) && !STALL.test(message.text())) complaints.push(`console ${message.type()}: ${message.text()}`);
  });
  page.on('pageerror', (error) => complaints.push(`page error: ${error.message}`));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) complaints.push(`request: ${request.url()}`);
  });
  await page.goto(pathToFileURL(resolve(file)).href);
  await page.waitForSelector('html[data-ready=true]', { state: 'attached' })
    .catch(() => complaints.push('the page never got ready'));
  await page.waitForTimeout(150);
  return { page, complaints };
}

/** Runs in the page: what was asked for and what is there. */
function survey() {
  let blocks = null;
  try {
    const data = JSON.parse(document.getElementById('hamel-data').textContent);
    blocks = data.sections.flatMap((section) => section.blocks ?? []).map((block) => block.kind);
  } catch { /* reported below */ }
  const rendered = [...document.querySelectorAll('[data-block]')].map((element) => ({
    kind: element.dataset.block, problem: element.classList.contains('problem') ? element.textContent : null,
    figure: element.matches('figure'),
    labelled: Boolean(element.querySelector('[role=img]')?.getAttribute('aria-label')),
    captioned: [...element.querySelectorAll('table')].every((t) => t.caption?.textContent.trim()),
    title: element.querySelector('figcaption, caption')?.textContent ?? '',
    empty: element.getBoundingClientRect().height < 8,
  }));
  return { blocks, rendered, unreadable: document.getElementById('unreadable')?.textContent ?? null,
    heading: document.querySelector('h1')?.getBoundingClientRect().bottom ?? null };
}

/** Whether a figure's data hold anything that can be drawn. */
function drawable() {
  const data = JSON.parse(document.getElementById('hamel-data').textContent);
  const good = (v, log) => typeof v === 'number' && (!log || v > 0);
  return data.sections.flatMap((section) => section.blocks ?? []).map((block) => {
    if (block.kind === 'sphere') return block.series.some((s) => s.points.filter((p) => p?.every(Number.isFinite)).length > 1);
    if (block.kind === 'heatmap') return !block.classes || block.values.flat().some((v) => v !== null && block.classes[v] !== 'open');  // a scale has colours; open contacts are grey
    if (block.kind === 'scatter') return block.columns.filter(({ values }) => values.filter(Number.isFinite).length > 1).length > 1;
    if (block.kind === 'animation') {
      return block.bodies.some(({ poses, shapes }) => poses[0]?.every(Number.isFinite) &&
        shapes.some(({ color }) => ['body', 'accent', undefined].includes(color)));
    }
    if (!['plot', 'path'].includes(block.kind)) return false;
    return block.series.flatMap((s) => s.x.filter((x, i) => good(x, block.log_x) && good(s.y[i], block.log_y))).length > 1;
  });
}

/** What the drawing of each figure shows, in the order of the page. */
async function picturesOf(page) {
  const drawings = await page.locator('figure[data-block] .drawing').all();
  const pngs = [];
  for (const drawing of drawings) pngs.push(await drawing.screenshot());
  return countPixels(page, pngs);
}

async function checkBlocks(page, check) {
  const found = await page.evaluate(survey);
  check('readable data', found.blocks !== null && !found.unreadable, found.unreadable ?? 'not JSON with sections');
  if (found.blocks === null) return { expected: [], solid: false };
  check('title above the fold', found.heading !== null && found.heading < 400);
  check('number of blocks', found.rendered.length === found.blocks.length,
    `${found.rendered.length} of ${found.blocks.length} rendered`);
  const expected = await page.evaluate(drawable);
  const pictures = await picturesOf(page);
  found.rendered.forEach((block, i) => {
    const name = `block ${i + 1} (${block.kind}${block.title ? `, ${block.title}` : ''})`;
    check(`${name} is shown`, !block.problem && !block.empty && block.kind === found.blocks[i], block.problem ?? 'empty or out of order');
    check(`${name} has captions`, block.captioned);
    if (!block.figure) return;
    check(`${name} has an aria-label`, block.labelled);
    const { inked, colours } = pictures.shift() ?? { inked: 0, colours: 0 };
    check(`${name} is not blank`, inked > 200, `${inked} inked pixels`);
    if (expected[i]) check(`${name} shows curves`, colours > 20, `${colours} coloured pixels`);
  });
  return { expected, solid: found.blocks.includes('sphere') || found.blocks.includes('animation') };
}

async function checkWidth(page, width, check) {
  await page.setViewportSize({ width, height: 800 });
  await page.waitForTimeout(250);
  const wide = await page.evaluate(() => {
    const limit = document.documentElement.clientWidth;
    if (document.documentElement.scrollWidth <= limit) return null;
    const guilty = [...document.querySelectorAll('main *')].filter((e) => e.getBoundingClientRect().right > limit + 1 && !e.closest('.scroll'));
    return `${document.documentElement.scrollWidth} > ${limit}: ${guilty.slice(0, 3).map((e) => `${e.tagName}.${e.className}`)}`;
  });
  check(`no horizontal overflow at ${width} px`, wide === null, wide ?? '');
  const cut = await page.evaluate(() => [...document.querySelectorAll('.chart svg')].flatMap((svg) => {
    const [left, right] = [svg.getBoundingClientRect().left - 1, svg.getBoundingClientRect().right + 1];
    return [...svg.querySelectorAll('text')].filter((text) => {
      const box = text.getBoundingClientRect();
      return box.width > 0 && (box.left < left || box.right > right);
    }).map((text) => `${svg.closest('figure')?.querySelector('.title')?.textContent}: ${text.textContent}`);
  }));
  check(`no words are cut at ${width} px`, cut.length === 0, cut.slice(0, 3).join('; '));
  const over = await page.evaluate(() => [...document.querySelectorAll('.chart svg')].flatMap((svg) => {
    const words = [...svg.querySelectorAll('text')].map((text) => ({ text: text.textContent, box: text.getBoundingClientRect() })).filter(({ text, box }) => text.trim() && box.width > 0);
    const meet = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 2 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 2;
    return words.flatMap((one, i) => words.slice(i + 1).filter(({ box }) => meet(one.box, box)).map(({ text }) => `${svg.closest('figure')?.querySelector('.title')?.textContent}: ${one.text} and ${text}`));
  }));
  check(`no words of a figure overlap at ${width} px`, over.length === 0, `${over.length}: ${over.slice(0, 3).join('; ')}`);
  const broken = await page.evaluate(() => [...document.querySelectorAll('main code')]
    .filter((code) => code.textContent.length < 30 && code.getClientRects().length > 1).map((code) => code.textContent));
  check(`no option is broken at ${width} px`, broken.length === 0, broken.slice(0, 3).join('; '));
}

/** Notes fill a phone: before the first figure there is one at most. */
async function checkOrder(page, check) {
  const before = await page.evaluate(() => {
    const blocks = [...document.querySelectorAll('[data-block]')];
    const first = blocks.findIndex((block) => block.matches('figure'));
    return first < 0 ? [] : blocks.slice(0, first).filter((block) => block.matches('.verdict.note')).map((block) => block.textContent);
  });
  check('the first figure comes before the notes', before.length <= 1, `${before.length} before it: ${before[1]?.slice(0, 60)}`);
}

/** A card that gets narrower shrinks its drawing at once: a plain screenshot may come before that is made again. */
async function checkShrinking(page, check) {
  const wide = await page.evaluate(() => {
    const main = document.querySelector('main');
    main.style.width = '280px';
    const out = [...document.querySelectorAll('.chart:not(.scroll *) svg')].filter((svg) => svg.getBoundingClientRect().right > svg.closest('.figure').getBoundingClientRect().right);
    main.style.width = '';
    return out.length;
  });
  check('drawings shrink with their cards', wide === 0, `${wide} do not`);
}

/** Uses the page wherever it has something to use: the watch is on complaints. */
async function useIt(page, check) {
  await useChart(page, check);
  for (const selector of ['.legend .entry', 'thead button']) {
    const button = page.locator(selector).first();
    if (!(await button.count())) continue;
    await button.click();
    await button.click();
  }
  await useSaving(page, check);
  await useHeatmap(page, check);
  await useFilters(page, check);
  await useTable(page, check);
  await useAnimation(page, check);
  await useSphere(page, check);
  await useScatter(page, check);
  await useMembers(page, check);
}

/** On paper every drawing is as wide as its frame at most, in light colours, and none is cut. */
async function checkPrint(page, check, path) {
  const pdf = await page.pdf({ preferCSSPageSize: true, path });
  check('prints to PDF', pdf.length > 5000);
  await page.setViewportSize({ width: 700, height: 1000 });
  await page.evaluate(() => window.dispatchEvent(new Event('beforeprint')));  // while the page has the screen's layout
  const rows = await page.evaluate(() => [...document.querySelectorAll('.table-block')].map((block) => ({ told: Boolean(block.querySelector('p.part')),
    rows: Math.max(...[...block.querySelectorAll('tbody')].map((body) => body.rows.length)) })));
  check('tables on paper are short, or tell that they go on', rows.every(({ rows: count, told }) => count <= 80 && (!told || count === 80)), JSON.stringify(rows));
  await page.emulateMedia({ media: 'print' });
  const kept = await page.evaluate(() => [...document.querySelectorAll('.table-block:has(div.part), div.part:has(tr:nth-child(41))')].filter((block) => getComputedStyle(block).breakInside === 'avoid').length);
  check('a table in parts does not ask for a page of its own', kept === 0, `${kept} do`);
  const cut = await page.evaluate(() => [...document.querySelectorAll('.drawing')].filter((drawing) => {
    const frame = drawing.closest('figure').getBoundingClientRect();
    const inside = ({ left, right }) => left >= frame.left - 1 && right <= frame.right + 1;
    const picture = drawing.querySelector('svg, canvas').getBoundingClientRect();
    return picture.width < 100 || picture.height < 60 || frame.bottom < picture.bottom || !inside(picture) || ![...drawing.querySelectorAll('.chart svg text')].every((text) => inside(text.getBoundingClientRect()));
  }).length);
  check('every drawing fits the paper', cut === 0, `${cut} do not`);
  const apart = await page.evaluate(() => [...document.querySelectorAll('.paired:first-child + .paired')].filter((map) => map.offsetTop !== map.previousElementSibling.offsetTop).length);
  check('maps of numbers are two a row on paper', apart === 0, `${apart} are not`);
  await page.emulateMedia({ media: null });
  await page.setViewportSize({ width: 1280, height: 800 });
  await page.evaluate(() => window.dispatchEvent(new Event('afterprint')));
  await page.waitForTimeout(250);
}

async function checkPage(browser, file, check, failures, { commands, options }) {
  const { page, complaints } = await open(browser, file);
  const odd = misfit(readFileSync(file, 'utf8'));
  check('the data fit schema.json', odd === '', odd);
  const { expected, solid } = await checkBlocks(page, check);
  await checkWidth(page, 390, check);
  await checkOrder(page, check);
  if (options.narrow) await page.screenshot({ path: options.narrow, fullPage: true });
  await checkWidth(page, 1280, check);
  if (options.screenshot) await page.screenshot({ path: options.screenshot, fullPage: true });
  await checkShrinking(page, check);
  await checkPrint(page, check, options.pdf);
  await useIt(page, check);
  if (expected.includes(true) && failures.length === 0) await lookPlainly(page, file, expected, check, options.plain, commands ? null : browser);
  check('no console message, error or request', complaints.length === 0, complaints.join('; '));
  if (solid) {  // once more without WebGL
    const flat = await open(browser, file, { webgl: false });
    await checkBlocks(flat.page, check);
    const figures = '.figure:is(.sphere, .animation)';
    const silent = await flat.page.locator(figures).filter({ hasNotText: 'without WebGL' }).count();
    check('without WebGL spheres and bodies are drawn all the same and say so', silent === 0, `${silent} say nothing`);
    if (options.fallback) await flat.page.locator(figures).first().screenshot({ path: options.fallback });
    await useAnimation(flat.page, check);
    check('no console message, error or request without WebGL', flat.complaints.length === 0, flat.complaints.join('; '));
  }
}

/** The checks of a page -> {passed, failures: texts}. `commands`: its plain pictures by chromium's own commands; `options`: files to write. */
export async function look(browser, file, { commands = false, options = {} } = {}) {
  let passed = 0;
  const failures = [];
  function check(name, good, detail = '') {
    if (good) ++passed;
    else failures.push(`FAILED ${name}${detail ? `: ${detail}` : ''}`);
  }
  try {
    await checkPage(browser, file, check, failures, { commands, options });
  } catch (error) {
    failures.push(`FAILED to go on: ${error.stack}`);
  }
  for (const context of browser.contexts()) await context.close();
  return { passed, failures };
}
