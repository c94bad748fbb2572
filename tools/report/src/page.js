// The whole page from the data in #hamel-data: header, contents, sections, blocks.

import './style.css';
import './figures.css';
import './print.css';
import { animation } from './stage/animation.js';
import { h, inline, problem } from './dom.js';
import { heatmap } from './charts/heatmap.js';
import { members } from './blocks/members.js';
import { assignStyles } from './charts/palette.js';
import { path, plot } from './charts/plot.js';
import { showPicture } from './picture.js';
import { preparePrinting } from './print.js';
import { record } from './blocks/record.js';
import { scatter } from './charts/scatter.js';
import { sphere } from './stage/sphere.js';
import { stateOf } from './state.js';
import { table } from './blocks/table.js';
import { text, verdict } from './blocks/text.js';

const MOTIONS = { path, sphere, animation };  // what a member may carry
const KINDS = { text, verdict, table, record, plot, path, sphere, heatmap, scatter, animation, members: (block) => members(block, (motion) => MOTIONS[motion.kind](motion)) };
const FIGURES = new Set(['plot', 'path', 'sphere', 'heatmap', 'scatter', 'animation']);
const HELP = 'Charts: a box drawn with the mouse zooms, Ctrl and wheel zoom at the pointer, a double click shows all again; the arrow ' +
  'keys read the points. A click on a name hides or shows its curve. Spheres and bodies turn by dragging or with the arrow keys; ' +
  'Ctrl and wheel or plus and minus zoom.';
const CHOOSING = ' A click on a dot, a point or a cell of a member shows this member; on a figure that is read by the arrow keys, Enter.';

function readData() {
  const source = document.getElementById('hamel-data')?.textContent.trim() ?? '';
  if (/^__[A-Z_]+__$/.test(source)) throw new Error('the page was never filled: its placeholder is still there.');
  const data = JSON.parse(source);
  if (data === null || typeof data !== 'object' || !Array.isArray(data.sections)) {
    throw new Error('there is no list "sections" in it.');
  }
  return data;
}

/** A block -> its element; what cannot be shown becomes a box that says why. */
function showBlock(block, number, later) {
  const kind = String(block?.kind);
  let element;
  if (!Object.hasOwn(KINDS, kind)) {
    element = problem(`Unknown kind of block: “${kind}”`, 'This page knows ' + Object.keys(KINDS).join(', ') + '.');
  } else {
    try {
      const shown = KINDS[kind](block);
      element = shown.element;
      if (shown.draw) later.push({ element, kind, draw: shown.draw });
    } catch (error) {
      element = broken(kind, error);
    }
  }
  element.dataset.block = kind;
  element.id = `block-${number}`;
  return element;
}

const broken = (kind, error) => problem(`This ${kind} could not be shown`, error.message);

/** Draws every figure at once -> promises of what is still to come (pictures by WebGL). */
function drawAll(later) {
  return later.map(({ element, kind, draw }) => {
    const fail = (error) => {
      const box = broken(kind, error);
      box.dataset.block = kind;
      element.replaceWith(box);
    };
    try {
      return Promise.resolve(draw()).catch(fail);
    } catch (error) {
      return fail(error);
    }
  });
}

/** Neighbouring figures share a grid: two side by side where there is room, wide ones one below the other. */
function showSection(section, place, counter, later) {
  const element = h('section', { id: `section-${place}`, 'aria-labelledby': `heading-${place}` },
    h('h2', { id: `heading-${place}` }, inline(section?.title)));
  let grid = null;
  for (const block of section?.blocks ?? []) {
    const shown = showBlock(block, ++counter.blocks, later);
    if (!FIGURES.has(block?.kind) || shown.classList.contains('problem')) {
      grid = null;
      element.append(shown);
    } else {
      const wide = shown.classList.contains('wide');
      if (!grid || wide !== grid.matches('.stacked')) element.append(grid = h('div', { class: wide ? 'figures stacked' : 'figures' }));
      grid.append(shown);
    }
  }
  return element;
}

function statusLine(data) {
  const state = stateOf(data.sections);
  if (!state) return null;
  const links = state.failed.flatMap((number, i) => [i ? ', ' : ': ', h('a', { href: `#block-${number}` }, `${i + 1}`)]);
  return h('p', { class: `state ${state.failed.length ? 'failed' : 'ok'}` }, state.text, links);
}

function header(data) {
  const when = String(data.generated ?? '').replace('T', ' ').replace(/\.\d+/, '').replace(/Z$/, ' UTC');
  const facts = [['generated', when], ['hamel', data.version], ['git', data.git], ['host', data.host]]
    .filter(([, value]) => value).map(([name, value]) => h('span', {}, `${name} `, h('b', {}, String(value))));
  return h('header', {}, h('h1', {}, inline(data.title || 'Report')),
    data.subtitle ? h('p', { class: 'subtitle' }, inline(data.subtitle)) : null,
    h('div', { class: 'strip' }, statusLine(data), h('p', { class: 'facts' }, facts)));
}

function contents(sections) {
  if (sections.length < 2) return null;
  return h('nav', { class: 'contents', 'aria-label': 'Contents' }, h('h2', {}, 'Contents'),
    h('ol', {}, sections.map((section, i) =>
      h('li', {}, h('a', { href: `#section-${i + 1}` }, inline(section?.title))))));
}

async function showPage() {
  let data;
  try {
    data = readData();
  } catch (error) {
    const box = problem('This report cannot be shown', `Its data could not be read: ${error.message}`);
    box.id = 'unreadable';
    document.body.append(h('main', {}, box));
    return;
  }
  document.title = String(data.title || 'Report').replace(/[`*]/g, '');
  assignStyles(data.sections);
  document.body.append(h('span', { id: 'light', class: 'light', hidden: true }));
  if (data.picture) return showPicture(data, (block) => KINDS[block.kind](block));
  const [later, counter] = [[], { blocks: 0 }];
  const nav = contents(data.sections);
  if (nav) document.body.classList.add('with-contents');
  const main = h('main', {}, data.sections.map((section, i) => showSection(section, i + 1, counter, later)));
  document.body.append(h('div', { class: 'page' }, header(data), nav, main,
    later.length ? h('footer', {}, HELP + (data.sections.some((section) => section?.blocks?.some((block) => block?.kind === 'members')) ? CHOOSING : '')) : null));
  preparePrinting();
  await Promise.all(drawAll(later));
}

showPage().then(() => requestAnimationFrame(() => { document.documentElement.dataset.ready = 'true'; }));
