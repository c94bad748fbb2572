// A table sorted by a click on a column's head: first rising, then falling, then as it was. With filters where the
// data asks for them. Long tables stand in a box of their own and grow while they are scrolled.

import { h, inline } from '../dom.js';
import { columnFormat, formatValue } from '../format.js';
import { onPaper } from '../print.js';
import { compare, makeFilter } from './table_filter.js';

const SLICE = 150;  // rows made at a time
const TALL = 40;    // more rows stand in a box
const PRINTED = 80; // rows on paper
const ROOM = 830;   // pixels of columns on the screen that A4 has room for: its text is smaller

export function table(block) {
  if (!Array.isArray(block.columns) || !Array.isArray(block.rows)) throw new Error('no list "columns" or "rows"');
  const numeric = block.columns.map((_, c) => {
    const cells = block.rows.map((row) => row?.[c]).filter((cell) => cell !== null && cell !== undefined);
    return cells.length > 0 && cells.filter((cell) => typeof cell === 'number').length * 2 > cells.length;
  });
  const formats = block.columns.map((_, c) => columnFormat(block.rows.map((row) => row?.[c])));
  const rows = block.rows.map((row, place) => ({ row: row ?? [], place }));
  const body = h('tbody');
  const heads = block.columns.map((name, c) => h('th', { scope: 'col', class: numeric[c] ? 'number' : null },
    h('button', { type: 'button', title: 'sort by this column', onclick: () => sort(c) },
      h('span', {}, inline(name)), h('span', { class: 'arrow', 'aria-hidden': 'true' }))));

  let sorted = { column: -1, direction: 1 };
  let order = rows;  // what passes the filter, sorted; the first rows of it are in the document
  const grow = (end) => body.append(...order.slice(body.childElementCount, end)
    .map((entry) => (entry.element ??= line(entry.row, numeric, formats))));
  const refill = () => {
    const kept = filter ? rows.filter((entry) => filter.passes(entry)) : [...rows];
    const { column, direction } = sorted;
    order = column < 0 ? kept : kept.sort((a, b) => compare(a.row[column], b.row[column], direction) || a.place - b.place);
    body.replaceChildren();
    grow(SLICE);
    box.scrollTop = 0;
    filter?.say(order.length, rows.length);
  };
  const sort = (c) => {
    if (sorted.column !== c) sorted = { column: c, direction: 1 };
    else if (sorted.direction === 1) sorted = { column: c, direction: -1 };
    else sorted = { column: -1, direction: 1 };
    heads.forEach((head, i) => {
      if (i !== sorted.column) head.removeAttribute('aria-sort');
      else head.setAttribute('aria-sort', sorted.direction === 1 ? 'ascending' : 'descending');
    });
    refill();
  };

  const box = h('div', { class: rows.length > TALL ? 'scroll tall' : 'scroll', tabindex: 0, role: 'region',
    'aria-label': `Table: ${block.title ?? 'untitled'}` },
    h('table', {}, h('caption', {}, block.title || 'Table'), h('thead', {}, h('tr', {}, heads)), body));
  box.addEventListener('scroll', () => {
    if (box.scrollTop + 3 * box.clientHeight > box.scrollHeight) grow(body.childElementCount + SLICE);
  });
  onPaper(() => {
    body.replaceChildren();
    grow(Math.min(order.length, PRINTED));
    splitForPaper(box);
    if (order.length > PRINTED)
      box.parentElement.append(h('p', { class: 'part remark' }, `The first ${PRINTED} of ${order.length} rows; what is sorted and filtered on the screen is printed so.`));
  }, () => {
    box.parentElement.querySelectorAll('.part').forEach((part) => part.remove());
    refill();
  });
  const filter = block.filter ? makeFilter(block, rows, refill) : null;
  refill();
  const element = h('div', { class: 'table-block' }, filter?.element, box,
    block.note ? h('p', { class: 'remark' }, inline(block.note)) : null);
  return { element };
}

/** A table wider than the page is printed in parts, each with the first column. */
function splitForPaper(box) {
  const whole = box.querySelector('table');
  const widths = [...whole.tHead.rows[0].cells].map((cell) => cell.offsetWidth);
  if (whole.offsetWidth <= ROOM) return;
  const parts = [[0]];
  let used = widths[0];
  widths.slice(1).forEach((width, i) => {
    if (used + width > ROOM && parts.at(-1).length > 1) {
      parts.push([0]);
      used = widths[0];
    }
    parts.at(-1).push(i + 1);
    used += width;
  });
  const copies = parts.map((columns, i) => {
    const copy = whole.cloneNode(true);
    for (const row of copy.rows) row.replaceChildren(...columns.map((c) => row.cells[c].cloneNode(true)));
    copy.caption.append(` (part ${i + 1} of ${parts.length})`);
    return h('div', { class: box.matches('.tall') ? 'part tall' : 'part' }, copy);
  });
  box.after(...copies);
}

/** 1.23·10⁻⁷ with the exponent in a column of its own. */
const aligned = (text) => {
  const [mantissa, exponent] = text.split('·');
  return exponent ? [mantissa, h('span', { class: 'exponent' }, `·${exponent}`)] : [text];
};

function line(row, numeric, formats) {
  return h('tr', {}, numeric.map((isNumber, c) => {
    const value = row[c];
    const exact = typeof value === 'number' && !Number.isInteger(value) ? String(value) : null;
    const status = ['ok', 'failed'].includes(value) ? `status ${value}` : null;
    const text = typeof value === 'string' ? inline(value) : typeof value === 'number' ? aligned(formats[c](value)) : [formatValue(value)];
    const short = typeof value === 'string' && value.length < 28 ? 'short' : null;
    return h('td', { class: isNumber ? 'number' : short, title: exact },
      status ? h('span', { class: status }, text) : text);
  }));
}
