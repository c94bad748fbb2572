// Sections of blocks as elements: of a report page, and of any page that draws such data, as often as it likes.

import './style.css';
import './figures.css';
import './print.css';
import { animation } from './stage/animation.js';
import { h, inline, problem } from './dom.js';
import { heatmap } from './charts/heatmap.js';
import { members } from './blocks/members.js';
import { path, plot } from './charts/plot.js';
import { record } from './blocks/record.js';
import { scatter } from './charts/scatter.js';
import { sphere } from './stage/sphere.js';
import { table } from './blocks/table.js';
import { text, verdict } from './blocks/text.js';

const MOTIONS = { path, sphere, animation };  // what a member may carry
/** Each kind of block: a function of it -> {element, draw, dispose} and what else that kind has. */
export const KINDS = { text, verdict, table, record, plot, path, sphere, heatmap, scatter, animation,
  members: (block) => members(block, (motion) => MOTIONS[motion.kind](motion)) };
const FIGURES = new Set(['plot', 'path', 'sphere', 'heatmap', 'scatter', 'animation']);

const broken = (kind, error) => problem(`This ${kind} could not be shown`, error.message);

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
      if (shown.draw) later.push({ element, kind, draw: shown.draw, dispose: shown.dispose });
    } catch (error) {
      element = broken(kind, error);
    }
  }
  element.dataset.block = kind;
  element.id = `block-${number}`;
  return element;
}

/** Draws every figure at once -> promises of what is still to come (pictures by WebGL). */
export function drawAll(later) {
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

/**
 * A section -> its element; what is to be drawn goes to `later`. Neighbouring figures share a grid: two side by side where
 * there is room, wide ones one below the other.
 */
export function showSection(section, place, counter, later) {
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
