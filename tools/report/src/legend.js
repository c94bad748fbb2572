// The legend under a figure: a button per series that hides it, with its value at the cursor.

import { h } from './dom.js';
import { styleOf } from './palette.js';

export const MANY = 12;  // more entries scroll, and the figure takes the whole width

function swatch({ colour, dash }, marker) {
  return h('svg', { class: 'swatch', viewBox: '0 0 28 10', width: 28, height: 10, 'aria-hidden': 'true' },
    h('line', { x1: 1, y1: 5, x2: 27, y2: 5, stroke: colour, 'stroke-width': 2.2,
      'stroke-dasharray': dash.length ? dash.join(' ') : null }),
    marker ? h('circle', { cx: 14, cy: 5, r: 3, fill: colour }) : null);
}

/**
 * entries: [{name, fit, style, markers}] -> {element, cursor, show(values, place), offer(i, offered, tags)}.
 * onToggle(i, visible) and onFocus(i or null) tell the figure.
 */
export function makeLegend(entries, { onToggle, onFocus = () => {}, live = true }) {
  const [values, tags] = [[], []];
  const items = entries.map((entry, i) => {
    const value = live ? h('span', { class: 'value', 'aria-hidden': 'true' }) : null;
    values.push(value);
    tags.push(h('span', { class: 'tags' }));
    return h('button', {
      type: 'button', class: 'entry', 'aria-pressed': 'true', title: 'show or hide',
      onclick: (event) => {
        const visible = event.currentTarget.getAttribute('aria-pressed') !== 'true';
        event.currentTarget.setAttribute('aria-pressed', String(visible));
        onToggle(i, visible);
      },
      onmouseenter: () => onFocus(i),
      onmouseleave: () => onFocus(null),
      onfocus: (event) => { if (event.currentTarget.matches(':focus-visible')) onFocus(i); },
      onblur: () => onFocus(null),
    }, swatch(entry.style ?? styleOf(entry), entry.markers), h('span', { class: 'words' },
      h('span', { class: 'name' }, entry.name), tags[i], entry.fit ? h('span', { class: 'fit' }, entry.fit) : null), value);
  });
  const cursor = live ? h('div', { class: 'cursor', 'aria-hidden': 'true' }) : null;
  const many = entries.length > MANY ? ' many' : '';
  const element = h('div', { class: `legend${live ? ' live' : ''}${many}` }, items);
  return {
    element,
    cursor,  // where the cursor stands, to be put over the chart
    /** A series may be taken out of the choice; `open` are tags that tell it from others of its name. */
    offer(i, offered, open) {
      items[i].hidden = !offered;
      tags[i].textContent = open.join(', ');
    },
    show(texts, place) {
      values.forEach((value, i) => { value.textContent = texts ? texts[i] : ''; });
      cursor.textContent = place ?? '';
    },
  };
}
