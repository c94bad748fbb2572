// The figures of curves: `plot` (over x) and `path` (in the plane, equal scales).

import { axisOptions, makeChart, TEXT, TOOLTIP } from './chart.js';
import { h } from '../dom.js';
import { figure, remark } from '../figure.js';
import { makeFilters } from './filters.js';
import { formatNumber, formatShort, logTicks, MISSING, niceTicks } from '../format.js';
import { readByKeys } from './keys.js';
import { makeLegend, MANY } from './legend.js';
import { DECADES, markings } from './markings.js';
import { choosable } from './choosing.js';
import { columnsToCsv } from '../save.js';
import { covered, extent, readSeries } from './series.js';
import { makeZoom, ZOOMS } from './zoom.js';
import { widest } from '../width.js';

const MARGIN = { left: 74, right: 18, top: 12, bottom: 46 };
const [BESIDE, BELOW] = [36, 11];  // pixels left of the numbers of the y axis: its name; from the x axis to its numbers, clear of those of y
const LEGEND_ROW = 24;
const [LONG, MOST_READ] = [2000, 14];  // longer curves are drawn by their least and greatest values, so many are read out
const [SAVED, FLATTER, LOWEST] = [720, 12 / 7, 190];  // a figure that is saved: pixels across, width over height, its least height
const SWATCH = 46;                     // pixels in the legend before a name

export const plot = (block) => chartFigure(block, readSeries(block, true), false);
export const path = (block) => chartFigure(block, readSeries(block, false), true);

function chartFigure(block, data, equal) {
  const { curves } = data;
  const points = new Set(curves.flatMap((curve) => curve.points.filter(isPoint).map(([x, y]) => `${x},${y}`)));
  if (points.size < 2) return { element: instead(block, data, points.size) };
  let drawn = null;
  const redraw = () => {
    drawn?.redraw();
    const groups = covered(data, equal);
    cover.textContent = groups.map((names) => `${names.join(names.some((name) => name.includes(',')) ? '; ' : ', ')} coincide.`).join(' ');
    cover.hidden = groups.length === 0;
  };
  const filters = makeFilters(block.filters, () => offer());
  const legend = makeLegend(curves, (i, visible) => {
    curves[i].show = curves[i].picked = visible;
    redraw();
  }, (i) => drawn?.chart.dispatchAction(i === null ? { type: 'downplay' } : { type: 'highlight', seriesId: String(i) }));
  const cover = remark('');
  const offer = () => {
    curves.forEach((curve, i) => {
      const passes = filters.passes(curve.tags);
      curve.show = curve.picked && passes;
      legend.offer(i, passes, filters.rest(curve.tags));
    });
    redraw();
  };
  const holder = h('div', { class: 'chart drawing', role: 'img', tabindex: 0, 'aria-label': describe(block, data, equal) });
  const zoom = makeZoom(holder, () => drawn.redraw());
  const alone = curves.length === 1 && (!curves[0].name || curves[0].name === block.title);
  const envelopes = curves.some((curve) => curve.envelope);
  const notes = [cover, envelopes ? remark('A shaded curve goes up and down more often than this figure can show: it is drawn from its least to its greatest values.') : null, data.hidden ? remark(`${data.hidden} point${data.hidden === 1 ? '' : 's'} at or below zero not drawn.`) : null,
    block.note ? remark(block.note) : null];
  const picture = (width) => {
    const shown = curves.filter((curve) => curve.show);
    const left = Math.min(MARGIN.left, width / 12);
    const wide = Math.min(widest(shown.map((curve) => curve.name)) + 8, width - left - SWATCH);
    const rows = alone ? 0 : Math.ceil(shown.length / Math.max(1, Math.floor((width - left) / (wide + SWATCH))));
    return drawn.picture(width, Math.max(LOWEST, Math.round(width / FLATTER)), rows ? rows * LEGEND_ROW + 6 : 0, {
      legend: { show: rows > 0, data: shown.map(({ name, markers }) => ({ name, itemStyle: { opacity: markers ? 1 : 0 } })), bottom: 2, left, right: 0, itemWidth: 28, itemGap: 12, textStyle: { ...TEXT, width: wide, overflow: 'truncate' }, selectedMode: false } });
  };
  const csv = () => columnsToCsv(block.series.flatMap((s) => [{ name: block.x ?? 'x', values: s.x },
    { name: `${s.name} ${block.y ?? ''}`.trim(), values: s.y }, ...(s.low ? [{ name: `${s.name}, least ${block.y ?? ''}`.trim(), values: s.low }] : [])]));
  const element = figure(block, [filters.element, holder, alone ? null : legend.element, notes], { svg: () => picture(SAVED), csv }, zoom.reset);
  if (curves.length > MANY) element.classList.add('wide');
  offer();

  const draw = () => {
    drawn = makeChart(holder, (width) => Math.min(320, Math.max(240, 0.72 * width)), (width, height) => option(block, data, equal, width, height, zoom.seen));
    zoom.watch(drawn.chart);
    const chosen = curves.some(({ points: [first] }) => first?.length > 2) ? choosable(holder, drawn.chart, curves) : null;
    readByKeys(holder, drawn.chart, (turn) => {
      const shown = curves.flatMap((curve, i) => (curve.show && curve.points.length ? [i] : []));
      const i = shown[((turn % shown.length) + shown.length) % shown.length];
      const series = drawn.chart.getModel().getSeries().find(({ id }) => id === String(i))?.seriesIndex ?? 0;
      return { series, points: curves[i]?.points.length ?? 0, curves: shown.length, choose: chosen && ((at) => chosen(curves[i].points[at][2])) };
    });
  };
  return { element, draw, picture, dispose: () => drawn?.dispose() };
}

const isPoint = (p) => p[0] !== null && p[1] !== null;

/** No axes for nothing, or for one point. */
function instead(block, data, count) {
  const what = count === 0 ? `nothing to draw${data.hidden ? ', no value is above zero' : ''}` :
    data.curves.filter((curve) => curve.points.some(isPoint)).map((curve) => {
      const [x, y] = curve.points.find(isPoint);
      return `${curve.name}: ${block.x || 'x'} = ${formatNumber(data.x.from(x))}, ${block.y || 'y'} = ${formatNumber(data.y.from(y))}`;
    }).join('; ');
  return h('p', { class: 'remark' }, h('b', {}, `${block.title ?? 'Plot'}: `), `${what}.`);
}

function describe(block, { curves, y }, equal) {
  const ranges = curves.map(({ name, points, lows }) => {
    const [low, high] = extent([...points, ...lows].map((p) => (p[1] === null ? null : y.from(p[1]))));
    return low <= high ? `${name} from ${formatShort(low, 3)} to ${formatShort(high, 3)}` : `${name} empty`;
  });
  return `${equal ? 'Path in the plane' : 'Plot'}: ${block.title ?? 'untitled'}; ${block.y || 'y'} against ${block.x || 'x'}; ` +
    `${ranges.join(', ')}. Left and right arrow keys read the points${curves.some(({ points: [first] }) => first?.length > 2) ? ', page keys change the curve, Enter shows the member' : ''}.`;
}

/** seen: the part of each axis that is zoomed to. */
function option(block, data, equal, width, height, seen) {
  const shown = data.curves.map((curve, i) => ({ ...curve, id: String(i) })).filter((curve) => curve.show && curve.points.length > 0);
  const margin = { ...MARGIN };
  const across = equal ? null : rangeOf(shown, 0, data.x);
  const marks = () => (equal ? null : markings(block, shown, data, seen.x ?? across, width - margin.left - margin.right));
  const { least, range } = marks() ?? {};
  const yTicks = (range) => ticksOf(data.y, seen.y ?? range, height / 50);
  const widthOf = (ticks) => Math.ceil(widest(ticks.at.map(ticks.read)));
  let ranges = equal ? null : { x: across, y: downTo(least, range ?? rangeOf(shown, 1, data.y)) };
  // Equal scales need the margin beforehand: that of their labels where those are wide, as of tiny numbers.
  if (equal) margin.left = Math.max(MARGIN.left, widthOf(yTicks(equalRanges(shown, width, height, margin).y)) + BESIDE);
  if (equal) ranges = equalRanges(shown, width, height, margin);
  const y = yTicks(ranges.y);
  const labels = equal ? margin.left - BESIDE : widthOf(y);
  margin.left = labels + BESIDE;
  return {
    grid: { ...margin, outerBoundsMode: 'none' },
    xAxis: oneAxis(data.x, ranges.x, 30, ticksOf(data.x, seen.x ?? ranges.x, Math.max(4, width / 90)), BELOW), yAxis: oneAxis(data.y, ranges.y, labels + 14, y),
    series: [...shown.filter((curve) => curve.lows.length).flatMap(band), ...shown.map((curve) => oneSeries(curve, !equal)), ...(marks()?.series ?? [])],  // now that the margin is known
    tooltip: { ...TOOLTIP, trigger: 'axis', axisPointer: { type: equal ? 'cross' : 'line', label: { show: equal, backgroundColor: 'var(--ink)', color: 'var(--paper)',
      formatter: ({ value, axisDimension }) => formatNumber(data[axisDimension].from(value)) }, lineStyle: { color: 'var(--soft)' }, crossStyle: { color: 'var(--soft)' } },
    showContent: !equal, formatter: (list) => readOut(list, data) },
    ...ZOOMS,
  };
}

const oneSeries = ({ id, name, style, points, lows, dots, markers, alone }, sorted) => ({
  id, name, type: 'line', data: points, clip: true, silent: true,
  showSymbol: Boolean(markers) || alone.size > 0, showAllSymbol: alone.size > 0 || 'auto', symbol: 'circle', symbolSize: dots ? 4.5 : markers ? 6.5 : (_, { dataIndex }) => (alone.has(dataIndex) ? 3.5 : 0), sampling: sorted && !dots && points.length > LONG ? 'minmax' : undefined,
  lineStyle: { color: style.colour, width: dots ? 0 : lows.length ? 1 : 1.6, type: style.dash.length ? style.dash : 'solid', cap: 'round', join: 'round' }, itemStyle: { color: style.colour, borderWidth: 0 },
  emphasis: { focus: 'series', lineStyle: { color: style.colour, width: dots ? 0 : 2.4 }, itemStyle: { color: style.colour } }, blur: { lineStyle: { opacity: 0.18 }, itemStyle: { opacity: 0.18 } },
  markPoint: sorted || !points[0] ? undefined : { silent: true, symbol: 'circle', symbolSize: 8, label: { show: false },
    itemStyle: { color: 'var(--paper)', borderColor: style.colour, borderWidth: 2 }, data: [{ coord: points.find(isPoint) ?? [0, 0] }] },
});

/** The area between the edges of a curve that is a band, and the lower one. */
const band = ({ id, style, points, lows }) => [
  { id: `band ${id}`, name: '', type: 'custom', data: [[points[0][0], points[0][1]]], clip: true, silent: true, tooltip: { show: false }, renderItem: (_, api) => ({
    type: 'polygon', shape: { points: [...points, ...[...lows].reverse()].filter(isPoint).map((p) => api.coord(p)) }, style: { fill: style.colour, opacity: 0.35 } }) },
  { id: `low ${id}`, name: '', type: 'line', data: lows, clip: true, silent: true, showSymbol: false, tooltip: { show: false }, lineStyle: { color: style.colour, width: 1 } }];

function rangeOf(shown, k, axis) {
  const markers = shown.some((curve) => curve.markers);
  const [min, max] = extent(shown.flatMap((curve) => [...curve.points, ...curve.lows].filter(isPoint).map((p) => p[k])));
  if (!(min <= max)) return [0, 1];
  if (axis.log) return max - min >= DECADES && k === 1 ? [Math.floor(min), Math.ceil(max)] : [min - 0.1, max + 0.1];
  const air = max > min ? (k === 1 ? 0.05 : markers ? 0.03 : 0) * (max - min) : (Math.abs(min) || 1) * 0.1;
  return [min - air, max + air];
}

const downTo = (least, [min, max]) => [least < min ? Math.floor(least) : min, max];

/** One unit of length is as long on both axes. */
function equalRanges(shown, width, height, margin) {
  const size = [width - margin.left - margin.right, height - margin.top - margin.bottom];
  const boxes = [0, 1].map((k) => rangeOf(shown, k, { log: false }));
  const unit = 1.06 * Math.max(...boxes.map(([min, max], k) => (max - min) / size[k]));
  const [x, y] = boxes.map(([min, max], k) => [(min + max - unit * size[k]) / 2, (min + max + unit * size[k]) / 2]);
  return { x, y };
}

/** Ticks in a range of an axis, about `count` -> {at, read(coordinate)}. */
const ticksOf = (axis, [min, max], count) => (axis.log ? logTicks : niceTicks)(min, max, count);

function oneAxis(axis, [min, max], gap, { at, read }, margin = 8) {
  const custom = { customValues: at };
  return axisOptions(axis.label, gap, { type: 'value', min, max, axisLabel: { ...custom, formatter: read, margin },
    axisTick: { ...custom, lineStyle: { color: 'var(--rule)' } }, splitLine: { ...custom, lineStyle: { color: 'var(--grid)' } } });
}

/** Of dots, all at that x. */
const beside = (curve, point) => (curve?.dots ? curve.points.filter((p) => p[0] === point[0]) : [point]);

/** What the curves are at the place of the pointer. */
function readOut(list, data) {
  if (!list.length) return '';
  const value = (axis, v) => (v === null || v === undefined ? MISSING : formatNumber(axis.from(v)));
  return h('div', {}, h('b', {}, `${data.x.label || 'x'} = ${value(data.x, list[0].axisValue)}`),
    list.filter(({ seriesName }) => seriesName).flatMap((one) => beside(data.curves[one.seriesId], one.data).map((point) => ({ ...one, point })))
      .slice(0, MOST_READ).map(({ seriesName, seriesId, dataIndex, point, color }) => {
        const low = data.curves[seriesId]?.lows[dataIndex];
        return h('div', { class: 'read' }, h('i', { style: `background:${color}` }), `${seriesName} `,
          h('span', {}, point[2] === undefined ? '' : `member ${point[2]}: `, `${low ? `${value(data.y, low[1])} … ` : ''}${value(data.y, point[1])}`));
      }));
}
