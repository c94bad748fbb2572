// The legend under a figure: a button a series, which hides or shows it.

import { h } from '../dom.js';

export const MANY = 12;  // more entries scroll, and the figure takes the whole width

export const swatch = ({ colour, dash }, { dots, markers, cell }) => cell ? h('svg', { class: 'swatch', viewBox: '0 0 14 11', width: 14, height: 11, 'aria-hidden': 'true' },
  h('rect', { width: 14, height: 11, fill: colour })) : h('svg', { class: 'swatch', viewBox: '0 0 28 10', width: 28, height: 10, 'aria-hidden': 'true' },
  dots ? null : h('line', { x1: 1, y1: 5, x2: 27, y2: 5, stroke: colour, 'stroke-width': 2.2, 'stroke-dasharray': dash.length ? dash.join(' ') : null }),
  markers ? h('circle', { cx: 14, cy: 5, r: 3, fill: colour }) : null);

/** curves: [{name, fit, style, dots, markers}] -> {element, offer(i, offered, tags)}; onToggle(i, visible), onFocus(i or null). */
export function makeLegend(curves, onToggle, onFocus = () => {}) {
  const tags = curves.map(() => h('span', { class: 'tags' }));
  const items = curves.map((curve, i) => h('button', {
    type: 'button', class: 'entry', 'aria-pressed': 'true', title: 'show or hide',
    onclick: ({ currentTarget: button }) => {
      const visible = button.getAttribute('aria-pressed') !== 'true';
      button.setAttribute('aria-pressed', String(visible));
      onToggle(i, visible);
    },
    onmouseenter: () => onFocus(i), onmouseleave: () => onFocus(null), onfocus: () => onFocus(i), onblur: () => onFocus(null),
  }, swatch(curve.style, curve), h('span', { class: 'words' },
    h('span', { class: 'name' }, curve.name), tags[i], curve.fit ? h('span', { class: 'fit' }, curve.fit) : null)));
  return {
    element: h('div', { class: `legend${curves.length > MANY ? ' many' : ''}` }, items),
    /** A series may be taken out of the choice; `open` are tags that tell it from others of its name. */
    offer(i, offered, open) {
      items[i].hidden = !offered;
      tags[i].textContent = open.join(', ');
    },
  };
}
