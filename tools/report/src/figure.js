// The frame around every figure: title, drawing, legend, notes.

import { h } from './dom.js';

export function figure(block, contents, ...tools) {
  return h('figure', { class: `figure ${block.kind}` },
    h('figcaption', {}, h('span', { class: 'title' }, block.title ?? ''), tools), contents);
}
