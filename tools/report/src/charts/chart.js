// A chart drawn by ECharts as SVG. Its colours are variables of the style sheet, so that dark mode and print need no
// second drawing. What is drawn comes in as `option(width, height)`.

import { init, use } from 'echarts/core';
import { CustomChart, HeatmapChart, LineChart } from 'echarts/charts';
import { DataZoomComponent, GridComponent, LegendComponent, MarkAreaComponent, MarkLineComponent, MarkPointComponent, ToolboxComponent,
  TooltipComponent, VisualMapComponent } from 'echarts/components';
import { SVGRenderer } from 'echarts/renderers';
import { onPaper } from '../print.js';

use([CustomChart, HeatmapChart, LineChart, DataZoomComponent, GridComponent, LegendComponent, MarkAreaComponent, MarkLineComponent, MarkPointComponent,
  ToolboxComponent, TooltipComponent, VisualMapComponent, SVGRenderer]);

export const FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Noto Sans', 'DejaVu Sans', sans-serif";  // (in an attribute of the SVG)
const PRINTED = 0.72;  // of its height on the screen is a chart on paper
const [WHOLE, HALF] = [664, 313];  // pixels: its width on A4, alone and beside another (print.css); other paper scales it
const WIDE_ON_PAPER = ':only-child, :is(.wide, .heatmap):not(.paired)';

export const TEXT = { color: 'var(--soft)', fontFamily: FONT, fontSize: 12 };
const BASE = { animation: false, textStyle: TEXT, legend: { show: false } };
export const TOOLTIP = { confine: true, className: 'tip', backgroundColor: 'var(--ink)', borderWidth: 0, padding: [4, 9],
  textStyle: { color: 'var(--paper)', fontSize: 12.5, fontFamily: FONT }, transitionDuration: 0, enterable: false };

/** Options of an axis; `more` as ECharts has them. */
export const axisOptions = (name, gap, more) => ({
  name, nameLocation: 'middle', nameGap: gap, nameTextStyle: { ...TEXT, fontSize: 13 }, axisLabel: { ...TEXT, hideOverlap: true, ...more.axisLabel },
  axisLine: { show: true, onZero: false, lineStyle: { color: 'var(--rule)' } }, axisTick: { show: true, lineStyle: { color: 'var(--rule)' } },
  splitLine: { lineStyle: { color: 'var(--grid)' } }, ...Object.fromEntries(Object.entries(more).filter(([key]) => key !== 'axisLabel')),
});

/** Width of a text on the screen, in pixels. */
const pen = document.createElement('canvas').getContext('2d');
export function widthOf(text, size = 12) {
  pen.font = `${size}px ${FONT}`;
  return pen.measureText(text).width;
}

/** The widest of the texts. */
export const widest = (texts, size) => Math.max(0, ...texts.map((text) => widthOf(text, size)));

/**
 * Draws into `holder`, which is `height(width)` tall, and again whenever its width changes and for paper.
 * -> {chart, redraw(), picture(width, height, room, more)}: `picture` is the SVG of that size, with room below for what the
 * options `more` put there.
 */
export function makeChart(holder, height, option) {
  let [width, tall] = [holder.clientWidth, 0];
  let chart = null;
  const redraw = (paper = 1) => {
    tall = Math.round(height(width) * paper);
    holder.style.height = `${tall}px`;
    chart ??= init(holder, null, { renderer: 'svg', width, height: tall });
    chart.resize({ width, height: tall });
    chart.setOption({ ...BASE, ...option(width, tall) }, { replaceMerge: ['series'] });
    chart.getZr().flush();
    holder.querySelector('svg').setAttribute('viewBox', `0 0 ${width} ${tall}`);  // paper may be narrower
  };
  redraw();
  followWidth(holder, () => {
    width = holder.clientWidth;
    redraw();
  });
  onPaper(() => {
    width = holder.closest('.figure').matches(WIDE_ON_PAPER) ? WHOLE : HALF;
    redraw(PRINTED);
  }, () => {
    width = holder.clientWidth;
    redraw();
  });
  const picture = (wide, high, room, more) => {
    const still = init(null, null, { renderer: 'svg', ssr: true, width: wide, height: high + room });
    const { grid, ...rest } = option(wide, high);
    still.setOption({ ...BASE, ...rest, grid: { ...grid, bottom: grid.bottom + room }, ...more });
    const svg = still.renderToSVGString();
    still.dispose();
    return svg;
  };
  return { chart, redraw: () => redraw(), picture };
}

/** Calls back, once a frame, when the element has another width. */
export function followWidth(element, callback) {
  let last = element.clientWidth;
  new ResizeObserver(() => requestAnimationFrame(() => {
    const width = element.clientWidth;
    if (width === last || width === 0 || matchMedia('print').matches) return;
    last = width;
    callback();
  })).observe(element);
}
