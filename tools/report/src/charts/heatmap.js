// The figure `heatmap`: one coloured cell per pair of values, read with the pointer or the arrow keys; values that are classes have a
// colour and a name each in place of a scale.

import { axisOptions, makeChart, TEXT, TOOLTIP } from './chart.js';
import { makeRing } from './choosing.js';
import { COLOURS, inkOn, sequential } from './colours.js';
import { h } from '../dom.js';
import { figure, remark } from '../figure.js';
import { formatNumber, formatShort, power } from '../format.js';
import { readByKeys } from './keys.js';
import { swatch } from './legend.js';
import { choose } from '../blocks/members.js';
import { colourOfMode, styleOf } from './palette.js';
import { columnsToCsv } from '../save.js';
import { extent } from './series.js';
import { widest, widthOf } from '../width.js';

const WIDE = 16;       // more columns take the whole width of the page
const [BAR, TOP] = [30, 8];
const ROOM = 22;       // pixels of a row of the legend of classes in a file
const [LONGEST, GAP] = [180, 10];  // pixels: the scale, and what is between it and its words
const [ROW, LEAST] = [26, 3.5];  // pixels: of a named row, of one of many numbers
const LINE = 15;       // pixels from a name to the next, at least
const SAVED = 720;
const HATCH = { type: 'pattern', repeat: 'repeat', imageWidth: 7, imageHeight: 7, image: `data:image/svg+xml,${encodeURIComponent(
  '<svg xmlns="http://www.w3.org/2000/svg" width="7" height="7"><path d="M-1 8L8 -1M-1 1L1 -1M6 8L8 6" stroke="#8d96a0" stroke-width="1"/></svg>')}` };

export function heatmap(block) {
  const map = readMap(block);
  const holder = h('div', { class: 'chart drawing', role: 'img', tabindex: 0, 'aria-label':
    `Heat map: ${block.title ?? 'untitled'}; ${map.columns.length} times ${map.rows.length} cells, ` +
    `${block.y || 'rows'} against ${block.x || 'columns'}. Arrow keys read the cells${map.members ? ', Enter shows the member' : ''}.` });
  let drawn = null;
  const tall = (width) => layout(map, width).height;
  const picture = (width) => (map.classes ? drawn.picture(width, tall(width), ROOM * rowsOf(map.classes, width), {
    legend: { show: true, data: map.classes.map(({ name }) => name), bottom: 2, left: GAP, itemWidth: 14, itemHeight: 11, itemGap: 12, textStyle: TEXT, selectedMode: false } }) :
    drawn.picture(width, tall(width), 0, {}));
  const csv = () => columnsToCsv([{ name: block.y || 'row', values: map.rows }, ...map.columns.map((name, c) =>
    ({ name, values: map.values.map((row, r) => map.classes?.[row[c]]?.name ?? row[c] ?? map.marks[r]?.[c] ?? '') }))]);
  const element = figure(block, [holder, map.hidden ? remark(`${map.hidden} cell${map.hidden === 1 ? '' : 's'} at or below zero left empty.`) : null,
    map.classes ? h('div', { class: 'legend' }, map.classes.map(({ name, colour, count }) => h('span', { class: 'entry fixed' }, swatch({ colour, dash: [] }, { cell: true }),
      h('span', { class: 'words' }, h('span', { class: 'name' }, name), h('span', { class: 'tags' }, `${count} cell${count === 1 ? '' : 's'}`))))) : null,
    map.only !== null && !map.classes ? remark(`Every value is ${scaleText(map, map.only)} ${block.unit ?? ''}.`) : null,
    map.values.flat().includes(null) ? remark(`A hatched cell has no value${reasons(map)}.`) : null, block.note ? remark(block.note) : null], { svg: () => picture(SAVED), csv });
  if (map.columns.length > WIDE) element.classList.add('wide');
  if (map.paired) element.classList.add('paired');
  const draw = () => {
    drawn = makeChart(holder, tall, (width) => option(map, block, layout(map, width)));
    const member = (i) => map.members?.[Math.floor(i / map.columns.length)][i % map.columns.length];
    readByKeys(holder, drawn.chart, () => ({ series: 0, points: map.columns.length * map.rows.length, columns: map.columns.length, choose: map.members && ((i) => choose(member(i), holder, true)) }));
    if (!map.members) return;
    holder.classList.add('choosable');
    drawn.chart.on('click', 'series.heatmap', ({ dataIndex }) => choose(member(dataIndex), holder));
    const { follow } = makeRing(holder, (wanted) => {
      const r = map.members.findIndex((row) => row.includes(wanted));
      if (r < 0) return null;
      const at = (c, row) => drawn.chart.convertToPixel({ xAxisIndex: 0, yAxisIndex: 0 }, [c, row]);
      const c = map.members[r].indexOf(wanted);
      const [x, y] = at(c, r);
      const { cell, row } = layout(map, holder.clientWidth);
      return [x, y, Math.max(8, cell), Math.max(8, row)];
    });
    drawn.chart.on('finished', follow);
  };
  return { element, draw, picture };
}

/** ": excluded, failed", the marks of cells without a value; "" for none, or too many. */
function reasons({ values, marks }) {
  const all = [...new Set(values.flatMap((line, r) => line.flatMap((value, c) => (value === null && marks[r]?.[c] ? [marks[r][c]] : []))))];
  return all.length && all.length < 4 ? `: ${all.join(', ')}` : '';
}

/** Rows of a legend of classes in so many pixels. */
const rowsOf = (classes, width) => Math.ceil(classes.reduce((sum, { name }) => sum + widthOf(name) + 32, 0) / (width - 2 * GAP));

/** The block -> {columns, rows: texts; values, marks, members: rows from the top; at(value): on the scale; range; scaled: it has two ends, only: or one
 * value; hidden; classes: [{name, colour, count}] or null}. */
function readMap(block) {
  for (const name of ['x_values', 'y_values', 'values']) {
    if (!Array.isArray(block[name])) throw new Error(`no list "${name}"`);
  }
  const [nx, ny] = [block.x_values.length, block.y_values.length];
  if (nx === 0 || ny === 0) throw new Error('"x_values" or "y_values" is empty');
  for (const [name, table] of [['values', block.values], ['marks', block.marks ?? block.values], ['members', block.members ?? block.values]]) {
    if (table.length !== ny) throw new Error(`"${name}" has ${table.length} rows, "y_values" has ${ny} values`);
    table.forEach((row, i) => {
      if (row?.length !== nx) throw new Error(`row ${i + 1} of "${name}" has ${row?.length} entries, "x_values" has ${nx}`);
    });
  }
  const at = (value) => (typeof value !== 'number' ? null : block.log ? (value > 0 ? Math.log10(value) : null) : value);
  const [columns, names] = [block.x_values, block.y_values].map((values) => values.map((v) => (typeof v === 'number' ? formatShort(v, 4) : String(v ?? ''))));
  const order = block.y_values.map((_, i) => i);
  const numbers = block.y_values.every((v) => typeof v === 'number');
  if (numbers && block.y_values[ny - 1] > block.y_values[0]) order.reverse();  // numbers grow upwards, names are read downwards
  const [min, max] = extent(block.values.flat().map(at));
  const classes = block.classes?.map((name, c) => ({ name: String(name), colour: colourOfMode(name) ? `var(${colourOfMode(name)})` : styleOf({ name }).colour, count: block.values.flat().filter((v) => v === c).length })) ?? null;
  return { label: String(block.y ?? ''), unit: block.unit ? `  ${block.unit}` : '', columns, rows: order.map((i) => names[i]), values: order.map((i) => block.values[i]), marks: order.map((i) => block.marks?.[i] ?? []), at, classes,
    members: block.members ? order.map((i) => block.members[i]) : null,
    range: min < max ? [min, max] : min === max ? [min - 0.5, max + 0.5] : [0, 1], scaled: min < max && !classes, only: min === max ? min : null, numbers,
    paired: numbers && block.x_values.every((v) => typeof v === 'number'),  // two a row on paper: no long names
    log: Boolean(block.log),
    hidden: block.values.flat().filter((v) => typeof v === 'number' && at(v) === null).length };
}

function layout(map, width) {
  const left = (map.label ? 34 : 14) + Math.ceil(Math.min(widest(map.rows), width * 0.42));
  // A name that is wider than its cell is centred on it, at the edge too.
  const names = widest(map.columns);
  const right = Math.max(12, (width - left - 12) / map.columns.length < 20 ? Math.ceil(names / 2) + 4 : 0);
  const cell = (width - left - right) / map.columns.length;
  const turned = names + 6 > cell && map.columns.length > 1 && !(cell < 20);
  const under = turned ? Math.min(90, names) + 30 : 42;
  const row = map.numbers ? Math.max(LEAST, Math.min(ROW, 430 / map.rows.length)) : ROW;
  // The scale and its words fit into the figure: first it moves left, then it gets shorter.
  const words = map.scaled ? widest([scaleText(map, map.range[0])]) + widest([scaleText(map, map.range[1]) + map.unit]) + 2 * GAP + 10 : 0;
  const long = Math.max(0, Math.min(LONGEST, width - 2 * GAP - words));
  const bar = { left: Math.max(GAP, Math.min(left, width - GAP - words - long)), itemHeight: long };
  return { left, right, cell, row, turned, under, bar, height: Math.round(TOP + Math.max(row * map.rows.length, widthOf(map.label, 13) + 4) + under + (map.scaled ? BAR : 0)) };
}

function option(map, block, { left, right, cell, row, turned, under, bar }) {
  const part = (value) => (map.at(value) - map.range[0]) / (map.range[1] - map.range[0]);
  const cells = map.values.flatMap((line, r) => line.map((value, c) => ({ value, mark: map.marks[r][c] || '', place: [c, r] })));
  const colourOf = (value) => (map.classes ? { color: map.classes[value]?.colour ?? HATCH } : {});
  const list = cells.map(({ value, mark, place }) => {
    const known = map.at(value) !== null;
    return { value: [...place, known ? map.at(value) : map.range[0]], visualMap: known && !map.classes, itemStyle: { borderColor: 'var(--paper)', borderWidth: row > 12 && cell > 5 ? 1 : 0,
      ...(known ? colourOf(value) : { color: typeof value === 'number' ? 'var(--paper)' : HATCH }) }, ...(known && map.classes ? { emphasis: { itemStyle: colourOf(value) } } : {}),
      label: { show: mark !== '' && (known || widthOf(mark, 11) + 6 <= cell), formatter: mark, color: known && !map.classes ? inkOn(sequential(part(value))) : 'var(--ink)', fontSize: 11, width: cell - 4, overflow: 'truncate',
        backgroundColor: known && !map.classes ? 'transparent' : 'var(--paper)', padding: [1, 3] } };
  });
  const name = (label, text) => `${label ? `${label}: ` : ''}${text}`;
  const names = { type: 'category', splitLine: { show: false } };
  const apart = (room, size) => ({ interval: Math.max(1, Math.ceil(room / size)) - 1 });  // so many cells without a name
  return {
    grid: { left, right, top: TOP, bottom: under + (map.scaled ? BAR : 0), outerBoundsMode: 'none' },
    xAxis: axisOptions(block.x || '', under - 16, { ...names, data: map.columns, axisLabel: { ...apart(turned ? LINE : Math.min(widest(map.columns) + GAP, Math.max(cell, 90)), cell), rotate: turned ? 90 : 0, width: turned ? 88 : undefined, overflow: 'truncate' }, axisTick: { show: false } }),
    yAxis: axisOptions(block.y || '', left - 14, { ...names, data: map.rows, inverse: true, axisLabel: { ...apart(LINE, row), width: left - (map.label ? 32 : 12), overflow: 'truncate' }, axisTick: { show: false } }),
    series: [{ type: 'heatmap', data: list, emphasis: { itemStyle: { borderColor: 'var(--ink)', borderWidth: 2 } } },
      // (for the legend of a file)
      ...(map.classes ?? []).map((one) => ({ type: 'line', name: one.name, data: [], symbol: 'rect', silent: true, tooltip: { show: false }, lineStyle: { opacity: 0 }, itemStyle: { color: one.colour } }))],
    visualMap: [{ type: 'continuous', show: map.scaled, textGap: GAP, seriesIndex: 0, dimension: 2, min: map.range[0], max: map.range[1], orient: 'horizontal', ...bar, bottom: 0, itemWidth: 11, padding: 2,
      inRange: { color: COLOURS }, precision: 12, text: [scaleText(map, map.range[1]) + map.unit, scaleText(map, map.range[0])], textStyle: TEXT, calculable: false }],
    tooltip: { ...TOOLTIP, trigger: 'item', formatter: ({ dataIndex }) => {
      const { value, mark, place: [c, r] } = cells[dataIndex];
      const text = map.classes && typeof value === 'number' ? map.classes[value]?.name ?? `class ${value}` : typeof value === 'number' ? `${formatNumber(value)} ${block.unit ?? ''}`.trim() : 'no value';
      return h('div', {}, h('div', {}, name(block.y, map.rows[r])), h('div', {}, name(block.x, map.columns[c])), h('div', {}, text + (mark ? ` (${mark})` : '')), map.members ? h('div', {}, `member ${map.members[r][c]}`) : null);
    } },
  };
}

const scaleText = ({ log }, value) => (log ? formatNumber(10 ** value, 3) : formatNumber(value, 3));
