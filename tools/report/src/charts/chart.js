// A chart drawn by ECharts as SVG. Its colours are variables of the style sheet, so that dark mode and print need no
// second drawing. What is drawn comes in as `option(width, height)`.

import { init, use } from 'echarts/core';
import { CustomChart, HeatmapChart, LineChart } from 'echarts/charts';
import { DataZoomComponent, GridComponent, LegendComponent, MarkAreaComponent, MarkLineComponent, MarkPointComponent, ToolboxComponent,
  TooltipComponent, VisualMapComponent } from 'echarts/components';
import { SVGRenderer } from 'echarts/renderers';
import { onPaper } from '../print.js';
import { followWidth, FONT } from '../width.js';

use([CustomChart, HeatmapChart, LineChart, DataZoomComponent, GridComponent, LegendComponent, MarkAreaComponent, MarkLineComponent, MarkPointComponent,
  ToolboxComponent, TooltipComponent, VisualMapComponent, SVGRenderer]);

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

/**
 * Draws into `holder`, which is `height(width)` tall, and again whenever its width changes and for paper.
 * -> {chart, redraw(), picture(width, height, room, more), dispose()}: `picture` is the SVG of that size, with room below for
 * what the options `more` put there; after `dispose` nothing holds the chart.
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
  const unfollow = followWidth(holder, () => {
    width = holder.clientWidth;
    redraw();
  });
  const offPaper = onPaper(() => {
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
  const dispose = () => {
    unfollow();
    offPaper();
    chart.dispose();
  };
  return { chart, redraw: () => redraw(), picture, dispose };
}
