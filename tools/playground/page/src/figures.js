// The figures of a run below its motion, as on its report page.

import { assignStyles } from '../../../report/src/charts/palette.js';
import { drawAll, showSection } from '../../../report/src/sections.js';

/** Draws sections into the element -> a function that ends what they hold. */
export function draw(holder, sections) {
  const later = [];
  const counter = { blocks: 0 };
  assignStyles(sections);
  holder.style.minHeight = `${holder.offsetHeight}px`;  // the page does not jump
  holder.replaceChildren(...sections.map((section, i) => showSection(section, i + 1, counter, later)));
  Promise.all(drawAll(later)).then(() => { holder.style.minHeight = ''; });
  return () => later.forEach(({ dispose }) => dispose?.());
}
