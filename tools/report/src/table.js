// A table sorted by a click on a column's head: first rising, then falling, then as it was.

import { h, inline } from './dom.js';
import { formatValue } from './format.js';

export function table(block) {
  if (!Array.isArray(block.columns) || !Array.isArray(block.rows)) throw new Error('no list "columns" or "rows"');
  const numeric = block.columns.map((_, c) => {
    const cells = block.rows.map((row) => row?.[c]).filter((cell) => cell !== null && cell !== undefined);
    return cells.length > 0 && cells.filter((cell) => typeof cell === 'number').length * 2 > cells.length;
  });
  const rows = block.rows.map((row, place) => ({ row, place, element: line(row, numeric) }));
  const body = h('tbody', {}, rows.map((row) => row.element));
  const heads = block.columns.map((name, c) => h('th', { scope: 'col', class: numeric[c] ? 'number' : null },
    h('button', { type: 'button', title: 'sort by this column', onclick: () => sort(c) },
      h('span', {}, inline(name)), h('span', { class: 'arrow', 'aria-hidden': 'true' }))));

  let sorted = { column: -1, direction: 1 };
  const sort = (c) => {
    if (sorted.column !== c) sorted = { column: c, direction: 1 };
    else if (sorted.direction === 1) sorted = { column: c, direction: -1 };
    else sorted = { column: -1, direction: 1 };
    heads.forEach((head, i) => {
      if (i !== sorted.column) head.removeAttribute('aria-sort');
      else head.setAttribute('aria-sort', sorted.direction === 1 ? 'ascending' : 'descending');
    });
    const order = sorted.column < 0 ? [...rows] : [...rows].sort((a, b) =>
      compare(a.row[c], b.row[c], sorted.direction) || a.place - b.place);
    body.append(...order.map((row) => row.element));
  };

  const element = h('div', { class: 'table-block' },
    h('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': `Table: ${block.title ?? 'untitled'}` },
      h('table', {}, h('caption', {}, block.title || 'Table'), h('thead', {}, h('tr', {}, heads)), body)),
    block.note ? h('p', { class: 'remark' }, inline(block.note)) : null);
  return { element };
}

function line(row, numeric) {
  return h('tr', {}, numeric.map((isNumber, c) => {
    const value = row?.[c];
    const exact = typeof value === 'number' && !Number.isInteger(value) ? String(value) : null;
    const status = ['ok', 'failed'].includes(value) ? `status ${value}` : null;
    const text = typeof value === 'string' ? inline(value) : [formatValue(value)];
    const short = typeof value === 'string' && value.length < 28 ? 'short' : null;
    return h('td', { class: isNumber ? 'number' : short, title: exact },
      status ? h('span', { class: status }, text) : text);
  }));
}

/** Numbers before texts; what is missing comes last in either direction. */
function compare(a, b, direction) {
  const missing = (v) => v === null || v === undefined || Number.isNaN(v);
  if (missing(a) || missing(b)) return missing(a) - missing(b);
  const [numberA, numberB] = [typeof a === 'number', typeof b === 'number'];
  if (numberA && numberB) return direction * (a - b);
  if (numberA !== numberB) return numberA ? -1 : 1;
  return direction * String(a).localeCompare(String(b), 'en', { numeric: true });
}
