// One helper that makes elements. Text is always set as text, never as markup.

import { prose } from './format.js';

const SVG_TAGS = new Set(['svg', 'g', 'line', 'circle', 'rect', 'path', 'text']);

/** h('p', {class: 'note'}, 'text', child…) -> element; a null attribute or child is left out. */
export function h(tag, attributes = {}, ...children) {
  const element = SVG_TAGS.has(tag)
    ? document.createElementNS('http://www.w3.org/2000/svg', tag)
    : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return element;
}

/** A plain text with `code` and **bold** -> list of nodes. */
export function inline(text) {
  const parts = String(text ?? '').split(/(`[^`]+`|\*\*[^*]+\*\*)/);
  return parts.filter((part) => part !== '').map((part) => {
    if (part.length > 2 && part.startsWith('`') && part.endsWith('`')) {
      const code = part.slice(1, -1);
      return h('code', { class: code.length < 30 ? 'short' : null }, code);
    }
    if (part.length > 4 && part.startsWith('**') && part.endsWith('**')) {
      return h('strong', {}, prose(part.slice(2, -2)));
    }
    return document.createTextNode(prose(part));
  });
}

/** The box that stands in for a block that cannot be shown. */
export function problem(heading, detail) {
  return h('div', { class: 'problem', role: 'alert' },
    h('strong', {}, heading), h('p', {}, detail));
}
