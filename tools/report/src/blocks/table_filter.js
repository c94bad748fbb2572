// The filter over a table: words that a row must hold, and a drop-down for each column of few values.

import { h } from '../dom.js';
import { formatValue } from '../format.js';

const FEW = 12;  // so many different values fit a drop-down

/** -> {element, passes(entry), say(shown, all)}; entry: {row}. */
export function makeFilter(block, rows, onChange) {
  const words = h('input', { type: 'search', placeholder: 'filter rows', 'aria-label': 'rows that hold these words',
    oninput: onChange });
  const choices = block.columns.map((name, c) => choice(name, c, rows, onChange)).filter(Boolean);
  const count = h('span', { class: 'count', role: 'status' });
  const text = (entry) => (entry.text ??= block.columns.map((_, c) => plain(entry.row[c])).join('\n').toLowerCase());
  return {
    element: h('div', { class: 'filters' }, words, choices.map(({ element }) => element), count),
    passes(entry) {
      const wanted = words.value.toLowerCase().split(/\s+/);
      return choices.every(({ accepts }) => accepts(entry.row)) && wanted.every((word) => text(entry).includes(word));
    },
    say(shown, all) { count.textContent = `${shown} of ${all} rows`; },
  };
}

/** What a reader may look for in a cell: the number as it is shown and as it is. */
const plain = (value) => (typeof value === 'number' ? `${formatValue(value)} ${value}` : formatValue(value));

/** The drop-down of a column; none where its values are many, all the same, or nowhere twice. */
function choice(name, column, rows, onChange) {
  const values = new Set();
  for (const { row } of rows) {
    values.add(row[column] ?? null);
    if (values.size > FEW) return null;
  }
  if (values.size < 2 || values.size === rows.length) return null;
  const list = [...values].sort((a, b) => compare(a, b, 1));
  const select = h('select', { onchange: onChange }, h('option', { value: -1 }, 'all'),
    list.map((value, i) => h('option', { value: i }, formatValue(value) || '(empty)')));
  return {
    element: h('label', {}, `${String(name).replace(/[`*]/g, '')} `, select),
    accepts: (row) => select.value === '-1' || (row[column] ?? null) === list[select.value],
  };
}

/** Numbers before texts; what is missing comes last in either direction. */
export function compare(a, b, direction) {
  const missing = (v) => v === null || v === undefined || Number.isNaN(v);
  if (missing(a) || missing(b)) return missing(a) - missing(b);
  const [numberA, numberB] = [typeof a === 'number', typeof b === 'number'];
  if (numberA && numberB) return direction * (a - b);
  if (numberA !== numberB) return numberA ? -1 : 1;
  return direction * COLLATOR.compare(String(a), String(b));
}

const COLLATOR = new Intl.Collator('en', { numeric: true });
