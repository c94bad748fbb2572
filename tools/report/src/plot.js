// The figures that uPlot draws: `plot` (curves over x) and `path` (curves in the plane, equal scales).

import { h, inline } from './dom.js';
import { MISSING } from './format.js';
import { nearestInPlane, nearestInX, readCurves } from './curves.js';
import { makeChart, refresh, View } from './chart.js';
import { makeFilters } from './filters.js';
import { makeLegend, MANY } from './legend.js';
import { onPrint } from './print.js';
import { figure } from './figure.js';

const HEIGHT = 320;
const PRINT_HEIGHT = { plot: 205, path: 290 };

const OVER_X = {
  sorted: true, equal: false, start: false,
  nearest: (curve, x, y, u) => nearestInX(curve, x, (u.scales.x.max - u.scales.x.min) * 0.01),
};
const IN_PLANE = {
  sorted: false, equal: true, start: true,
  nearest: (curve, x, y, u) => {
    const reach = (24 * (u.scales.x.max - u.scales.x.min)) / u.over.clientWidth;  // 24 pixels
    return nearestInPlane(curve, x, y, reach, reach);
  },
};

export function plot(block) {
  const data = readCurves(block, { sorted: true, logX: block.log_x, logY: block.log_y });
  return chartFigure(block, data, OVER_X, 'Plot');
}

export function path(block) {
  return chartFigure(block, readCurves(block, { sorted: false }), IN_PLANE, 'Path in the plane');
}

function chartFigure(block, data, manner, kind) {
  const filters = makeFilters(block.filters, () => {
    offer();
    if (!view.zoomed) view.goHome();
    u?.batch(() => data.curves.forEach((curve, i) => u.setSeries(i + 1, { show: curve.show })));
    redraw();
  });
  const holder = h('div', { class: 'chart', role: 'img', 'aria-label': describe(block, data, kind) });
  const reset = h('button', { type: 'button', class: 'reset', hidden: true,
    onclick: () => { view.goHome(); redraw(); } }, 'reset zoom');
  let u = null;

  const redraw = () => {
    reset.hidden = !view.zoomed;
    if (u) refresh(u);
  };
  const legend = makeLegend(data.curves, {
    onToggle: (i, visible) => {
      data.curves[i].show = data.curves[i].picked = visible;
      if (!view.zoomed) view.goHome();
      u.setSeries(i + 1, { show: visible });
      redraw();
    },
    onFocus: (i) => { if (data.curves.length > 1) u.setSeries(i === null ? null : i + 1, { focus: true }); },
  });

  const offer = () => data.curves.forEach((curve, i) => {
    const passes = filters.passes(curve.tags);
    curve.show = curve.picked && passes;
    legend.offer(i, passes, filters.rest(curve.tags));
  });
  offer();
  const view = new View(data, manner.equal);
  holder.append(legend.cursor);
  const notes = [];
  if (data.hidden > 0) {
    const points = data.hidden === 1 ? '1 point' : `${data.hidden} points`;
    notes.push(h('p', { class: 'remark' }, `${points} at or below zero not drawn.`));
  }
  if (block.note) notes.push(h('p', { class: 'remark' }, inline(block.note)));
  const element = figure(block, [filters.element, holder, legend.element, ...notes].filter(Boolean), reset);
  if (data.curves.length > MANY) element.classList.add('wide');

  const draw = () => {
    u = makeChart(holder, data, view, manner, {
      width: holder.clientWidth, height: HEIGHT,
      on: { cursor: (chart) => showCursor(chart, data, manner, legend), zoom: redraw },
    });
    activate(u);
    followWidth(holder, (width) => {
      u.setSize({ width, height: HEIGHT });
      if (manner.equal) refresh(u);
    });
    onPrint(holder, PRINT_HEIGHT[block.kind], (place, width, height, k) =>
      makeChart(place, data, view, manner, { width: width * k, height: height * k, k }).ctx.canvas);
  };
  return { element, draw };
}

function showCursor(u, data, manner, legend) {
  if (u.cursor.left < 0) {
    legend.show(null);
    return;
  }
  const read = (axis, coordinate) => axis.read(coordinate, 4);
  const texts = data.curves.map((curve, i) => {
    const index = u.cursor.idxs[i + 1];
    if (!curve.show || index === null || index === undefined) return curve.show ? MISSING : '';
    const y = read(data.y, curve.y[index]);
    return manner.equal ? `${read(data.x, curve.x[index])}, ${y}` : y;
  });
  const x = `${data.x.label || 'x'} = ${read(data.x, u.posToVal(u.cursor.left, 'x'))}`;
  const y = `${data.y.label || 'y'} = ${read(data.y, u.posToVal(u.cursor.top, 'y'))}`;
  legend.show(texts, manner.equal ? `${x}, ${y}` : x);
}

function describe(block, data, kind) {
  const names = data.curves.map((curve) => curve.name).join(', ');
  return `${kind}: ${block.title ?? 'untitled'}; ${block.y ?? 'y'} against ${block.x ?? 'x'}; series: ${names}`;
}

/** A click makes a chart take the wheel until the pointer leaves it. */
function activate(u) {
  u.over.addEventListener('click', () => u.root.classList.add('active'));
  u.over.addEventListener('mouseleave', () => u.root.classList.remove('active'));
}

/** Calls back, once a frame, when the element has another width. */
export function followWidth(element, callback) {
  let last = element.clientWidth;
  new ResizeObserver(() => requestAnimationFrame(() => {
    const width = element.clientWidth;
    if (width === last || width === 0) return;
    last = width;
    callback(width);
  })).observe(element);
}
