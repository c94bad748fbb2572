// One figure alone, for a file: what a plain chromium prints of the document is its SVG, percent-encoded.

import { h } from './dom.js';
import { plainSvg } from './save.js';

/** data.picture: {block: its number on the page, width: pixels}; make(block) -> {element, draw, picture(width) -> SVG}. */
export function showPicture({ sections, picture: { block: number, width } }, make) {
  const { element, draw, picture } = make(sections.flatMap((section) => section.blocks)[number - 1]);
  const text = h('pre', { id: 'picture' });
  document.body.append(h('div', { style: `width: ${width}px` }, element), text);
  if (!picture) return;  // nothing to draw: its words stand in the element
  draw();
  element.querySelector('.drawing').style.width = `${width}px`;
  text.textContent = encodeURIComponent(plainSvg(picture(width)));
}
