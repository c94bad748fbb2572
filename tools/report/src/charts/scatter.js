// The figure `scatter`: all pairs of columns as dots, a dot for each member in each pair; the names and histograms in the diagonal,
// correlations above it. Drawn as SVG: the dots of a class in one pair are one path.

import { h } from '../dom.js';
import { figure, remark } from '../figure.js';
import { formatNumber, formatShort, niceTicks } from '../format.js';
import { makeLegend } from './legend.js';
import { choose, onChoice, state } from '../blocks/members.js';
import { styleOf } from './palette.js';
import { onPaper } from '../print.js';
import { columnsToCsv } from '../save.js';
import { extent } from './series.js';
import { followWidth, FONT, widthOf } from '../width.js';

const [LEFT, RIGHT, TOP, BOTTOM] = [58, 10, 8, 34];
const [LEAST, TALLEST, FLATTER] = [88, 150, 0.8];  // pixels of a cell: its least width, its greatest height; height over width
const PAPER = 664;     // pixels across on A4
const SAVED = 820;     // pixels across in a file
const AIR = 0.06;      // of a cell, beside the outermost dots
const MANY = 1200;     // more dots are smaller
const NEAR = 14;       // pixels: a click means the nearest dot
const BINS = 24;
const ROW = 22;        // pixels of the legend in a file
const SMALL = `font: 11px/1 ${FONT}; fill: var(--soft)`;

/** The block -> {columns: [{name, unit, values, range}], groups: [{name, style, dots}], members, count}. */
function readMatrix(block) {
  if (!Array.isArray(block.columns) || block.columns.length < 2) throw new Error('a list "columns" of at least two is needed');
  const count = block.columns[0].values?.length ?? 0;
  block.columns.forEach(({ name, values }) => {
    if (values?.length !== count) throw new Error(`column ${name} has ${values?.length} values, ${block.columns[0].name} has ${count}`);
  });
  for (const name of ['members', 'class']) {
    if (block[name] && block[name].length !== count) throw new Error(`"${name}" has ${block[name].length} entries for ${count} dots`);
  }
  const names = block.classes ?? ['members'];
  const all = Array.from({ length: count }, (_, i) => i);
  const columns = block.columns.map((column) => {
    const [min, max] = extent(column.values);
    const air = max > min ? AIR * (max - min) : min <= max ? (Math.abs(min) || 1) * 0.1 : 1;
    return { ...column, range: min <= max ? [min - air, max + air] : [0, 1] };
  });
  const groups = names.map((name, c) => ({ name, style: styleOf({ name }), dots: block.class ? all.filter((i) => block.class[i] === c) : all, show: true }))
    .filter(({ dots }) => dots.length > 0);
  return { columns, groups, members: block.members ?? null, count };
}

function layout({ columns }, width) {
  const wide = Math.max(width, LEFT + RIGHT + LEAST * columns.length);
  const cell = (wide - LEFT - RIGHT) / columns.length;
  const tall = Math.min(TALLEST, Math.max(70, FLATTER * cell));
  return { wide, cell, tall, high: TOP + tall * columns.length + BOTTOM };
}

export function scatter(block) {
  const data = readMatrix(block);
  const { columns, groups } = data;
  let [place, at, current] = [null, -1, -1];  // layout, the dot of the keyboard, the dot that is marked
  const holder = h('div', { class: 'chart drawing matrix', role: 'img', tabindex: 0, 'aria-label': describe(block, data) });
  const said = h('span', { class: 'unseen', role: 'status' });
  const tip = h('div', { class: 'tip', hidden: true });
  const legend = groups.length > 1 ? makeLegend(groups.map(({ name, style }) => ({ name, style, dots: true, markers: true })), (i, visible) => {
    groups[i].show = visible;
    draw();
  }) : null;
  const picture = (width) => {
    const of = layout(data, width);
    const shown = groups.length > 1 ? groups.filter(({ show }) => show) : [];
    const words = shown.flatMap(({ name, style }, i) => [h('circle', { cx: LEFT + 6, cy: of.high + (i + 0.5) * ROW, r: 4, fill: style.colour }),
      h('text', { x: LEFT + 18, y: of.high + (i + 0.5) * ROW + 4, style: `font: 12px/1 ${FONT}; fill: var(--ink)` }, name)]);
    const svg = drawing(data, of, of.high + shown.length * ROW);
    svg.append(...words);
    return new XMLSerializer().serializeToString(svg);
  };
  const csv = () => columnsToCsv([...(data.members ? [{ name: 'member', values: data.members }] : []), ...columns.map(({ name, unit, values }) => ({ name: label(name, unit), values })),
    ...(block.class ? [{ name: 'class', values: block.class.map((c) => block.classes[c] ?? '') }] : [])]);
  const element = figure(block, [h('div', { class: 'scroll' }, holder), said, legend?.element ?? null, block.note ? remark(block.note) : null], { svg: () => picture(SAVED), csv });
  if (columns.length > 2) element.classList.add('wide');

  const ring = h('g', { class: 'marked' });
  const mark = (i) => {
    current = i;
    ring.replaceChildren(...(i < 0 || !place ? [] : cells(columns.length).filter(([r, c]) => c < r).flatMap(([r, c]) => {
      const [x, y] = spot(data, place, i, r, c);
      return Number.isFinite(x + y) ? [h('circle', { cx: x, cy: y, r: 6, style: 'fill: none; stroke: var(--paper); stroke-width: 4.5' }),
        h('circle', { cx: x, cy: y, r: 6, style: 'fill: none; stroke: var(--ink); stroke-width: 2' })] : [];
    })));
  };
  const draw = (paper = 0) => {
    place = layout(data, paper || holder.parentElement.clientWidth);
    const svg = drawing(data, place, place.high);
    svg.append(ring);
    holder.style.height = `${place.high}px`;
    holder.replaceChildren(svg, tip);
    mark(current);
  };
  const words = (i) => `${data.members ? `member ${data.members[i]}: ` : ''}${columns.map(({ name, unit, values }) => `${name} = ${formatNumber(values[i], 5)} ${unit ?? ''}`.trim()).join(', ')}`;
  const find = (event) => {
    const box = holder.querySelector('svg').getBoundingClientRect();
    const scale = place.wide / box.width;
    return nearest(data, place, (event.clientX - box.left) * scale, (event.clientY - box.top) * scale);
  };
  const show = (i, x = 0, y = 0) => {
    tip.hidden = i < 0;
    tip.textContent = i < 0 ? '' : words(i);
    tip.style.cssText = `left:${Math.min(x + 14, Math.max(0, holder.clientWidth - 230))}px;top:${y + 18}px`;
  };
  const chosen = () => (state.chosen === null ? -1 : data.members?.indexOf(state.chosen) ?? -1);
  holder.addEventListener('mousemove', (event) => {
    const i = find(event);
    const { left, top } = holder.getBoundingClientRect();
    show(i, event.clientX - left, event.clientY - top);
    if (i !== current) mark(i < 0 ? chosen() : i);
  });
  holder.addEventListener('mouseleave', () => { show(-1); mark(chosen()); });
  holder.addEventListener('click', (event) => {
    const i = find(event);
    if (i >= 0 && data.members) choose(data.members[i], holder);
  });
  holder.addEventListener('blur', () => { said.textContent = ''; });
  holder.addEventListener('keydown', (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: -10, ArrowDown: 10, Home: -data.count, End: data.count }[event.key];
    if (event.key === 'Enter' && at >= 0 && data.members) choose(data.members[at], holder, true);
    if (!step || data.count === 0) return;
    event.preventDefault();
    at = Math.max(0, Math.min(data.count - 1, at + step));
    mark(at);
    said.textContent = words(at);
  });
  onChoice(() => mark(chosen()));
  return { element, picture, draw: () => {
    draw();
    followWidth(holder.parentElement, () => draw());
    onPaper(() => draw(PAPER), () => draw());
  } };
}

const label = (name, unit) => (unit ? `${name} [${unit}]` : name);
const cells = (n) => Array.from({ length: n * n }, (_, i) => [Math.floor(i / n), i % n]);

function describe(block, { columns, count }) {
  return `Scatter matrix: ${block.title ?? 'untitled'}; ${count} dots in each pair of ${columns.map(({ name, values }) => {
    const [low, high] = extent(values);
    return low <= high ? `${name} (${formatShort(low, 3)} to ${formatShort(high, 3)})` : name;
  }).join(', ')}. Left and right arrow keys read the dots${block.members ? ', Enter shows the member' : ''}.`;
}

const along = ([min, max], value) => (value - min) / (max - min);
const number = (v) => (typeof v === 'number' ? v : NaN);

/** Where the dot i stands in the cell of row r and column c. */
function spot({ columns }, { cell, tall }, i, r, c) {
  const [x, y] = [columns[c], columns[r]];
  return [LEFT + cell * (c + along(x.range, number(x.values[i]))), TOP + tall * (r + 1 - along(y.range, number(y.values[i])))];
}

/** The dot nearest to a place of the drawing, -1 where none is near. */
export function nearest(data, of, x, y) {
  const [c, r] = [Math.floor((x - LEFT) / of.cell), Math.floor((y - TOP) / of.tall)];
  if (c < 0 || r >= data.columns.length || c >= r) return -1;
  let [best, distance] = [-1, NEAR];
  for (const { dots, show } of data.groups) {
    if (!show) continue;
    for (const i of dots) {
      const [px, py] = spot(data, of, i, r, c);
      const away = Math.hypot(px - x, py - y);
      if (away < distance) [best, distance] = [i, away];
    }
  }
  return best;
}

function drawing(data, of, high) {
  const { columns, groups, count } = data;
  const { wide, cell, tall } = of;
  const parts = [];
  const line = (x1, y1, x2, y2, colour) => h('line', { x1, y1, x2, y2, stroke: colour, 'stroke-width': 1 });
  for (const [r, c] of cells(columns.length)) {
    const [left, top] = [LEFT + cell * c, TOP + tall * r];
    if (c > r) parts.push(...correlation(data, r, c, left + cell / 2, top + tall / 2));
    else parts.push(h('rect', { x: left, y: top, width: cell, height: tall, style: 'fill: none; stroke: var(--line)' }));
    if (c === r) parts.push(...diagonal(columns[c], groups, left, top, of));
  }
  columns.forEach(({ range }, k) => {
    for (const { at, text } of ticks(range, cell, (words) => widthOf(words, 11))) {
      const x = LEFT + cell * (k + at);
      const bottom = TOP + tall * columns.length;
      parts.push(line(x, bottom, x, bottom + 4, 'var(--rule)'), h('text', { x, y: bottom + 16, style: `${SMALL}; text-anchor: middle` }, text));
    }
    if (k === 0) return;  // its row has the histogram alone
    for (const { at, text } of ticks(range, tall, () => 14)) {
      const y = TOP + tall * (k + 1 - at);
      parts.push(line(LEFT - 4, y, LEFT, y, 'var(--rule)'), h('text', { x: LEFT - 7, y: y + 4, style: `${SMALL}; text-anchor: end` }, text));
    }
  });
  const size = count > MANY ? 2.4 : 4;
  for (const { dots, style, show } of groups) {
    if (!show) continue;
    for (const [r, c] of cells(columns.length)) {
      if (c >= r) continue;
      const d = dots.map((i) => spot(data, of, i, r, c)).filter(([x, y]) => Number.isFinite(x + y)).map(([x, y]) => `M${x.toFixed(1)} ${y.toFixed(1)}h0`).join('');
      if (d) parts.push(h('path', { d, stroke: style.colour, 'stroke-width': size, 'stroke-linecap': 'round', 'stroke-opacity': count > MANY ? 0.65 : 0.85, fill: 'none' }));
    }
  }
  return h('svg', { width: wide, height: high, viewBox: `0 0 ${wide} ${high}`, 'aria-hidden': 'true' }, parts);
}

/** Ticks of a range that have room -> [{at: 0 to 1, text, length}]; room(text): the pixels that it takes along the axis. */
function ticks([min, max], pixels, room) {
  for (let wanted = 6; wanted >= 2; --wanted) {
    const { at, read } = niceTicks(min, max, wanted);
    const all = at.map((v) => ({ at: along([min, max], v), text: read(v), length: room(read(v)) }))
      .filter((tick) => Math.min(tick.at, 1 - tick.at) * pixels + 2 >= tick.length / 2);
    if (all.every((tick, i) => i === 0 || (tick.at - all[i - 1].at) * pixels > (tick.length + all[i - 1].length) / 2 + 8)) return all;
    if (wanted === 2) return all.slice(0, 1);
  }
  return [];
}

/** Pearson's coefficient; from the data where it is of more members than are drawn. */
function correlation({ columns }, r, c, x, y) {
  const value = columns[r].correlation?.[c];
  if (typeof value !== 'number') return [];
  const strong = Math.abs(value);
  return [h('text', { x, y: y + 5, style: `font: ${strong >= 0.5 ? 600 : 400} ${Math.round(12 + 3 * strong)}px/1 ${FONT}; fill: var(${strong >= 0.1 ? '--ink' : '--soft'}); text-anchor: middle` },
    value.toFixed(2).replace('-', '−'))];
}

/** The name over a histogram, the classes one on the other. */
function diagonal({ name, unit, values, range }, groups, left, top, { cell, tall }) {
  const [words, room] = [label(name, unit), cell - 10];
  const lines = wrapped(words, room);
  const floor = top + tall;
  const reach = tall - 12 - 14 * lines.length;
  const counts = groups.map(() => new Array(BINS).fill(0));
  groups.forEach(({ dots, show }, g) => show && dots.forEach((i) => {
    const at = along(range, number(values[i]));
    if (at >= 0 && at <= 1) ++counts[g][Math.min(BINS - 1, Math.floor(at * BINS))];
  }));
  const most = Math.max(1, ...counts[0].map((_, b) => counts.reduce((sum, list) => sum + list[b], 0)));
  const bars = groups.map(({ style }, g) => {
    const d = counts[g].map((n, b) => {
      const under = counts.slice(0, g).reduce((sum, list) => sum + list[b], 0);
      return n === 0 ? '' : `M${(left + (cell * b) / BINS).toFixed(1)} ${(floor - (reach * under) / most).toFixed(1)}h${(cell / BINS).toFixed(2)}v${(-(reach * n) / most).toFixed(1)}h${(-cell / BINS).toFixed(2)}z`;
    }).join('');
    return d && h('path', { d, fill: style.colour, 'fill-opacity': 0.55 });
  }).filter(Boolean);
  return [...bars, ...lines.map((text, i) => h('text', { x: left + cell / 2, y: top + 15 + 14 * i, style: `font: 600 12px/1 ${FONT}; fill: var(--ink); text-anchor: middle` }, text))];
}

/** A name in at most two lines, broken after a dot, a bracket or a space, cut where that is not enough. */
function wrapped(text, room) {
  const wide = (words) => widthOf(words, 12) * 1.08 > room;
  const cut = (words) => {
    let out = words;
    while (wide(out) && out.length > 2) out = `${out.slice(0, -2)}…`;
    return out;
  };
  if (!wide(text)) return [text];
  const parts = text.split(/(?<=[._ (),*+-])/);
  let first = '';
  while (parts.length && !wide(first + parts[0])) first += parts.shift();
  return first ? [first.trim(), cut(parts.join('').trim())].filter(Boolean) : [cut(text)];
}
