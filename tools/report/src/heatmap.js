// The figure `heatmap`: one coloured cell per pair of values; the cell under the pointer or reached with the arrow
// keys is read out.

import { Axis } from './axis.js';
import { h, inline } from './dom.js';
import { figure } from './figure.js';
import { formatNumber, formatShort } from './format.js';
import { drawMap } from './heatmap_draw.js';
import { followWidth } from './plot.js';
import { onPrint } from './print.js';

const WIDE = 16;  // more columns take the whole width of the page

export function heatmap(block) {
  const map = readMap(block);
  const canvas = h('canvas', { 'aria-hidden': 'true' });
  const frame = h('div', { class: 'cell', hidden: true });
  const tip = h('div', { class: 'tip', role: 'status' });
  const holder = h('div', { class: 'chart cells', role: 'img', tabindex: 0, 'aria-label':
    `Heat map: ${block.title ?? 'untitled'}; ${map.columns.length} times ${map.rows.length} cells, ` +
    `${map.y.label || 'rows'} against ${map.x.label || 'columns'}. Arrow keys read the cells.` }, canvas, frame, tip);
  let place = null;  // the layout on the screen

  const notes = [];
  if (map.hidden) notes.push(`${map.hidden === 1 ? '1 cell' : `${map.hidden} cells`} at or below zero left white.`);
  const element = figure(block, [holder, notes.map((text) => h('p', { class: 'remark' }, text)),
    block.note ? h('p', { class: 'remark' }, inline(block.note)) : null]);
  if (map.columns.length > WIDE) element.classList.add('wide');

  const show = (column, row) => {
    const cell = row === null || column === null ? null : map.rows[row]?.cells[column];
    frame.hidden = !cell;
    tip.textContent = cell ? readCell(map, column, row) : '';
    if (!cell) return;
    const [left, top] = [place.left + column * place.width, place.top + row * place.height];
    Object.assign(frame.style, { left: `${left}px`, top: `${top}px`, width: `${place.width}px`, height: `${place.height}px` });
    tip.style.left = `${Math.max(0, Math.min(left + place.width / 2 - tip.offsetWidth / 2, holder.clientWidth - tip.offsetWidth))}px`;
    const above = top - tip.offsetHeight - 6;
    tip.style.top = `${above >= -30 ? above : top + place.height + 6}px`;
  };
  handle(holder, canvas, map, () => place, show);

  const paint = () => {
    place = drawMap(canvas, map, holder.clientWidth, Math.max(1, devicePixelRatio));
    holder.style.height = `${place.total}px`;
    show(null, null);
  };
  const draw = () => {
    paint();
    followWidth(holder, paint);
    onPrint(holder, 0, (stage, width, _, k) => {
      const paper = h('canvas');
      stage.append(paper);
      drawMap(paper, map, width, k);
      return paper;
    });
  };
  return { element, draw };
}

/** The block -> {x, y: {label, texts, numbers}, value: Axis, range, unit, columns, rows: [{text, cells}], empty, hidden}. */
function readMap(block) {
  for (const name of ['x_values', 'y_values', 'values']) {
    if (!Array.isArray(block[name])) throw new Error(`no list "${name}"`);
  }
  const [nx, ny] = [block.x_values.length, block.y_values.length];
  if (nx === 0 || ny === 0) throw new Error('"x_values" or "y_values" is empty');
  for (const [name, table] of [['values', block.values], ['marks', block.marks ?? block.values]]) {
    if (table.length !== ny) throw new Error(`"${name}" has ${table.length} rows, "y_values" has ${ny} values`);
    table.forEach((row, i) => {
      if (row?.length !== nx) throw new Error(`row ${i + 1} of "${name}" has ${row?.length} entries, "x_values" has ${nx}`);
    });
  }
  const value = new Axis(block.unit, block.log, block.values);
  const cells = block.values.map((row, i) => row.map((v, c) => ({
    value: v, mark: String(block.marks?.[i][c] ?? ''), at: value.to(v), missing: typeof v !== 'number',
  })));
  const all = cells.flat();
  const known = all.map((cell) => cell.at).filter(Number.isFinite);
  const range = value.home(known.reduce((a, b) => Math.min(a, b), Infinity), known.reduce((a, b) => Math.max(a, b), -Infinity), 0);
  const [x, y] = [block.x_values, block.y_values].map((values, i) => ({
    label: String((i ? block.y : block.x) ?? ''), numbers: values.every((v) => typeof v === 'number'),
    texts: values.map((v) => (typeof v === 'number' ? formatShort(v, 4) : String(v ?? ''))),
  }));
  const rows = cells.map((row, i) => ({ text: y.texts[i], cells: row }));
  const rises = y.numbers && block.y_values[ny - 1] > block.y_values[0];
  if (rises) rows.reverse();  // numbers grow upwards, names are read downwards
  return { x, y, value, range, unit: String(block.unit ?? ''), columns: x.texts, rows, empty: all.some((cell) => cell.missing),
    hidden: all.filter((cell) => !cell.missing && Number.isNaN(cell.at)).length };
}

function readCell(map, column, row) {
  const cell = map.rows[row].cells[column];
  const name = (axis, text) => (axis.label ? `${axis.label}: ${text}` : text);
  const value = cell.missing ? 'no value' : `${formatNumber(cell.value)} ${map.unit}`.trim();
  return `${name(map.y, map.rows[row].text)}\n${name(map.x, map.columns[column])}\n${value}${cell.mark ? ` (${cell.mark})` : ''}`;
}

function handle(holder, canvas, map, placeNow, show) {
  let [column, row] = [0, 0];  // of the keyboard
  canvas.addEventListener('pointermove', (event) => {
    const { left, top, width, height } = placeNow();
    const [c, r] = [Math.floor((event.offsetX - left) / width), Math.floor((event.offsetY - top) / height)];
    const inside = c >= 0 && c < map.columns.length && r >= 0 && r < map.rows.length;
    if (inside) [column, row] = [c, r];
    show(inside ? c : null, inside ? r : null);
  });
  canvas.addEventListener('pointerleave', () => show(null, null));
  holder.addEventListener('blur', () => show(null, null));
  holder.addEventListener('focus', () => { if (holder.matches(':focus-visible')) show(column, row); });
  holder.addEventListener('keydown', (event) => {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (event.key === 'Escape') show(null, null);
    if (!step) return;
    event.preventDefault();
    column = Math.max(0, Math.min(map.columns.length - 1, column + step[0]));
    row = Math.max(0, Math.min(map.rows.length - 1, row + step[1]));
    show(column, row);
  });
}
