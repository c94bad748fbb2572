// The whole page from the data in #hamel-data: header, contents, sections, blocks.

import { h, inline, problem } from './dom.js';
import { assignStyles } from './charts/palette.js';
import { showPicture } from './picture.js';
import { preparePrinting } from './print.js';
import { drawAll, KINDS, showSection } from './sections.js';
import { stateOf } from './state.js';

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
  if (data.picture) return showPicture(data, (block, options) => KINDS[block.kind](block, options));
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
