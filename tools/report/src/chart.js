// A chart drawn by uPlot: axes, curves, cursor, zoom. What differs between a plot over time and a path in the
// plane comes in as the `manner`: {sorted, equal, nearest}.

import uPlot from 'uplot';
import { bounds, trace } from './curves.js';

export const FONT = 'system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif';
const [INK, GRID, LINE] = ['#4a525c', '#e7eaee', '#aab2bb'];

/** The range shown, in drawn coordinates: home, zoomed, or home again. */
export class View {
  constructor(data, equal) {
    Object.assign(this, { data, equal, zoomed: false });
    this.goHome();
  }

  goHome() {
    const box = bounds(this.data.curves);
    const markers = this.data.curves.some((curve) => curve.markers);
    this.x = this.data.x.home(...box.x, this.equal ? 0.04 : markers ? 0.03 : 0);
    this.y = this.data.y.home(...box.y, 0.05);
    this.zoomed = false;
  }

  zoom(x, y) {
    const tiny = (range) => !(range[1] - range[0] > 1e-12 * Math.max(Math.abs(range[0]), Math.abs(range[1])));
    if (tiny(x) || tiny(y)) return;
    [this.x, this.y, this.zoomed] = [x, y, true];
  }

  /** [x, y] as drawn in a plot area of width × height: with equal scales when the view wants them. */
  fitted(width, height) {
    if (!this.equal || !(width > 0) || !(height > 0)) return [this.x, this.y];
    const unit = Math.max((this.x[1] - this.x[0]) / width, (this.y[1] - this.y[0]) / height);
    const around = ([min, max], size) => [(min + max - unit * size) / 2, (min + max + unit * size) / 2];
    return [around(this.x, width), around(this.y, height)];
  }
}

function axisOptions(axis, side, k) {
  const horizontal = side === 2;  // (font sizes in whole pixels: uPlot scales no others)
  let ticks = { at: [], labels: [] };
  return {
    scale: horizontal ? 'x' : 'y', side, stroke: INK, label: axis.label, labelGap: 0, labelSize: 20 * k,
    font: `${12 * k}px ${FONT}`, labelFont: `${13 * k}px ${FONT}`, gap: 5 * k,
    incrs: (u, i, min, max) => [Math.max(5, 2 * (max - min))],  // any that uPlot takes: the ticks are ours
    splits: (u, i, min, max) => {
      const room = horizontal ? u.width / k / 95 : (u.height / k - 60) / 34;
      ticks = axis.ticks(min, max, Math.max(2, Math.floor(room)));
      return ticks.at;
    },
    filter: (u, splits) => splits,
    values: () => ticks.labels,
    size: (u, labels) => {
      if (horizontal) return 26 * k;
      u.ctx.save();
      u.ctx.font = `${12 * k}px ${FONT}`;
      const widest = Math.max(0, ...(labels ?? []).map((label) => u.ctx.measureText(label).width));
      u.ctx.restore();
      return Math.ceil(widest + 12 * k);
    },
    grid: { stroke: GRID, width: k, filter: (u, splits) => splits.map((v, i) => (ticks.labels[i] ? v : null)) },
    ticks: { stroke: LINE, width: k, size: 4 * k },
    border: { show: true, stroke: LINE, width: k },
  };
}

/**
 * Builds the chart in `holder`. k scales text and lines (2: a sharp copy for paper); without `on` it is a
 * still picture. on: {cursor(indices, place), zoom()}.
 */
export function makeChart(holder, data, view, manner, { width, height, k = 1, on = null }) {
  const { curves } = data;
  const area = (u) => [u.bbox.width, u.bbox.height];
  const paths = (u, i) => {
    const { line, dots } = trace(curves[i - 1],
      (v) => u.valToPos(v, 'x', true), (v) => u.valToPos(v, 'y', true), 3.2 * k * devicePixelRatio);
    return { stroke: line, fill: dots, clip: null, band: null, gaps: null, flags: 0 };
  };
  const options = {
    mode: 2, width, height, pxAlign: 0, legend: { show: false }, focus: { alpha: 0.18 },
    padding: [(on ? 18 : 8) * k, 16 * k, 0, 2 * k],
    scales: {
      x: { time: false, auto: false, range: (u) => view.fitted(...area(u))[0] },
      y: { auto: false, range: (u) => view.fitted(...area(u))[1] },
    },
    axes: [axisOptions(data.x, 2, k), axisOptions(data.y, 3, k)],
    series: [{}, ...curves.map((curve) => ({
      label: curve.name, show: curve.show, auto: false, facets: [{ scale: 'x' }, { scale: 'y' }],
      stroke: curve.style.colour, fill: curve.style.colour, width: 1.6 * k,
      dash: curve.style.dash.map((d) => d * k * devicePixelRatio), cap: curve.style.dash.length ? 'butt' : 'round',
      points: { show: false }, paths,
    }))],
    cursor: on ? cursorOptions(data, view, manner, on) : { show: false },
    hooks: {
      drawClear: [(u) => {
        u.ctx.fillStyle = '#fff';
        u.ctx.fillRect(0, 0, u.ctx.canvas.width, u.ctx.canvas.height);
      }],
      draw: [(u) => { if (bounds(curves).x[0] === Infinity) say(u, 'nothing to draw', k); }],
      drawSeries: manner.start ? [(u, i) => drawStart(u, curves[i - 1], k)] : [],
      setCursor: on ? [(u) => on.cursor(u)] : [],
      setSelect: on ? [(u) => zoomToSelection(u, data, view, on)] : [],
    },
  };
  const u = new uPlot(options, [null, ...curves.map((curve) => [curve.x, curve.y])], holder);
  if (on) u.over.addEventListener('wheel', (event) => zoomByWheel(event, u, view, manner, on), { passive: false });
  return u;
}

/** Lets uPlot ask for its ranges again, after the view, the size or the visible curves have changed. */
export function refresh(u) {
  u.batch(() => {
    u.setScale('x', { min: null, max: null });
    u.setScale('y', { min: null, max: null });
  });
}

function cursorOptions(data, view, manner, on) {
  return {
    x: !manner.equal, y: false, drag: { x: true, y: true, uni: 24, dist: 4, setScale: false },
    points: { size: 7, width: 1.5, fill: '#fff', stroke: (u, i) => data.curves[i - 1].style.colour },
    dataIdx: (u, i) => {
      const curve = data.curves[i - 1];
      if (u.cursor.left < 0 || !curve.show) return null;
      return manner.nearest(curve, u.posToVal(u.cursor.left, 'x'), u.posToVal(u.cursor.top, 'y'), u);
    },
    bind: { dblclick: () => () => { view.goHome(); on.zoom(); } },
  };
}

function zoomToSelection(u, data, view, on) {
  const { left, top, width, height } = u.select;
  if (width < 4 && height < 4) return;
  view.zoom([u.posToVal(left, 'x'), u.posToVal(left + width, 'x')],
    [u.posToVal(top + height, 'y'), u.posToVal(top, 'y')]);
  u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  on.zoom();
}

/** The wheel zooms where a plain wheel would not scroll the page: with Ctrl, or after a click in the chart. */
function zoomByWheel(event, u, view, manner, on) {
  if (!event.ctrlKey && !event.metaKey && !u.root.classList.contains('active')) return;
  event.preventDefault();
  const factor = Math.exp(Math.max(-60, Math.min(60, event.deltaY)) * 0.004);
  const around = ([min, max], centre) => [centre + (min - centre) * factor, centre + (max - centre) * factor];
  const { x, y } = u.scales;
  const nextX = around([x.min, x.max], u.posToVal(u.cursor.left, 'x'));
  const nextY = manner.equal ? around([y.min, y.max], u.posToVal(u.cursor.top, 'y')) : [y.min, y.max];
  view.zoom(nextX, nextY);
  on.zoom();
}

function say(u, text, k) {
  const { left, top, width, height } = u.bbox;
  Object.assign(u.ctx, { font: `${13 * k * devicePixelRatio}px ${FONT}`, fillStyle: INK, textAlign: 'center' });
  u.ctx.fillText(text, left + width / 2, top + height / 2);
}

function drawStart(u, curve, k) {
  const first = curve.x.findIndex((x, i) => Number.isFinite(x) && Number.isFinite(curve.y[i]));
  if (first < 0) return;
  const [x, y] = [u.valToPos(curve.x[first], 'x', true), u.valToPos(curve.y[first], 'y', true)];
  const { left, top, width, height } = u.bbox;
  if (x < left || x > left + width || y < top || y > top + height) return;
  u.ctx.save();
  u.ctx.setLineDash([]);
  u.ctx.beginPath();
  u.ctx.arc(x, y, 3.6 * k * devicePixelRatio, 0, 2 * Math.PI);
  Object.assign(u.ctx, { fillStyle: '#fff', strokeStyle: curve.style.colour, lineWidth: 1.8 * k * devicePixelRatio });
  u.ctx.fill();
  u.ctx.stroke();
  u.ctx.restore();
}
