// The figures of a run below its motion, as on its report page.

import { assignStyles } from '../../../report/src/charts/palette.js';
import { drawAll, showSection } from '../../../report/src/sections.js';

const LATER = 300;  // milliseconds

/** The motion goes on between two of them; a run that is driven has the page alone. */
async function pause() {
  await new Promise((resolve) => { globalThis.requestIdleCallback ? requestIdleCallback(resolve, { timeout: LATER }) : setTimeout(resolve); });
  while (document.querySelector('.drive')) await new Promise((resolve) => { setTimeout(resolve, LATER); });
}

/** Draws sections into the element, a figure at a time -> a function that ends what they hold. */
export function draw(holder, sections) {
  const later = [];
  const counter = { blocks: 0 };
  assignStyles(sections);
  holder.style.minHeight = `${holder.offsetHeight}px`;  // the page does not jump
  holder.replaceChildren(...sections.map((section, i) => showSection(section, i + 1, counter, later)));
  let ended = false;
  const work = async () => {
    for (const one of later) {
      await pause();
      if (ended) return;
      await drawAll([one])[0];
    }
    holder.style.minHeight = '';
    holder.dataset.drawn = 'true';
  };
  delete holder.dataset.drawn;
  work();
  return () => {
    ended = true;
    later.forEach(({ dispose }) => dispose?.());
  };
}
