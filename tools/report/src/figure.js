// The frame around every figure: title, buttons that save it, drawing, legend, notes.

import { h, inline } from './dom.js';
import { saveData, savePng, saveSvg } from './save.js';

/** `exports`: {svg() -> text, csv() -> text} and, where a PNG shows another picture, png() -> SVG of it; further tools stand before these buttons. */
export function figure(block, contents, exports, ...tools) {
  const name = String(block.title || block.kind).toLowerCase().replace(/[^\p{L}\p{N}]+/gu, '-');
  const button = (label, title, onclick) => h('button', { type: 'button', class: 'save', title, onclick }, label);
  const saves = [exports?.svg && button('SVG', 'save the figure as SVG', () => saveSvg(name, exports.svg())),
    exports?.svg && button('PNG', 'save the figure as PNG', () => savePng(name, (exports.png ?? exports.svg)())),
    exports?.csv && button('CSV', 'save the data of the figure as CSV', () => saveData(name, exports.csv()))].filter(Boolean);
  return h('figure', { class: `figure ${block.kind}` },
    h('figcaption', {}, h('span', { class: 'title' }, inline(block.title)), h('span', { class: 'tools' }, tools, saves)), contents);
}

export const remark = (text) => h('p', { class: 'remark' }, inline(text));
