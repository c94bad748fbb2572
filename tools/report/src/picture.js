// One figure alone, for a file: what a plain chromium prints of the document is its SVG or its frames; or the player of a motion.

import { h } from './dom.js';
import { plainSvg } from './save.js';

/**
 * data.picture: {block: its number on the page, width: pixels}; make(block, options) -> {element, draw, picture(width) -> SVG}.
 * Of a motion also {height, at: times, strobe: times before them, frames, sharper, transparent, player}: of `frames` the PNG at
 * each time `at`, a line each; `player` is the page itself.
 */
export function showPicture({ sections, picture: options }, make) {
  const { block: number, width, height, at, strobe, frames, sharper, transparent, player } = options;
  const block = sections.flatMap((section) => section.blocks)[number - 1];
  if (player) return showPlayer(block, options, make);
  const shown = make(block, height ? { height: () => height } : {});
  const text = h('pre', { id: 'picture' });
  document.body.append(h('div', { style: `width: ${width}px` }, shown.element), text);
  if (!shown.picture) return undefined;  // nothing to draw: its words stand in the element
  shown.element.querySelector('.drawing').style.width = `${width}px`;
  if (frames) {
    document.documentElement.classList.add('paper');
    const take = shown.film(sharper, transparent);
    text.textContent = at.map((t) => take(t, strobe).toDataURL('image/png')).join('\n');
    return undefined;
  }
  shown.draw();
  if (at) shown.hold(at[0], strobe);
  const svg = plainSvg(shown.picture(width), transparent);
  text.textContent = encodeURIComponent(sharper ? svg.replace(/width="[\d.]+" height="[\d.]+"/, `width="${width * sharper}" height="${height * sharper}"`) : svg);
  return undefined;
}

/** The motion alone: as large as it is told, or as its window. */
function showPlayer(block, { width, height }, make) {
  const above = 150;  // title and player
  const shown = make(block, { height: (wide) => height ?? Math.max(200, Math.min(0.8 * wide, innerHeight - above)) });
  document.body.append(h('main', { class: 'alone', style: width ? `max-width: ${width}px` : '' }, shown.element));
  return shown.draw();
}
