// Zooming a chart: a box drawn with the mouse, Ctrl and the wheel, two fingers; a double click shows all again.

import { h } from '../dom.js';

const touched = matchMedia('(pointer: coarse)').matches;  // there a finger on a chart scrolls the page
const inside = (axis) => ({ type: 'inside', [axis]: 0, filterMode: 'none', zoomOnMouseWheel: 'ctrl', moveOnMouseMove: false, moveOnMouseWheel: false, disabled: touched });

/** Options of a chart that can be zoomed. */
export const ZOOMS = {
  dataZoom: [inside('xAxisIndex'), inside('yAxisIndex')],
  toolbox: { itemSize: 0, showTitle: false, feature: { dataZoom: { filterMode: 'none', brushStyle: { color: '#0b5c9922', borderColor: '#0b5c9977', borderWidth: 1 } } } },
};

/** -> {reset: a button, seen: {x, y} ranges zoomed to, watch(chart)}; onZoom() runs when they change. */
export function makeZoom(holder, onZoom) {
  let chart = null;
  const seen = { x: null, y: null };
  const home = () => {
    chart.dispatchAction({ type: 'dataZoom', batch: chart.getOption().dataZoom.map((_, dataZoomIndex) => ({ dataZoomIndex, start: 0, end: 100 })) });
  };
  const reset = h('button', { type: 'button', class: 'reset', hidden: true, onclick: home }, 'reset zoom');
  holder.addEventListener('dblclick', home);
  const watch = (drawn) => {
    chart = drawn;
    chart.on('datazoom', () => {
      const model = chart.getModel();
      const ranges = ['x', 'y'].map((axis) => model.getComponent(`${axis}Axis`).axis.scale.getExtent());
      const { dataZoom } = chart.getOption();
      const zoomed = dataZoom.some(({ start, end }) => start > 1e-9 || end < 100 - 1e-9);
      Object.assign(seen, zoomed ? { x: ranges[0], y: ranges[1] } : { x: null, y: null });
      reset.hidden = !zoomed;
      onZoom();
    });
    if (!touched) chart.dispatchAction({ type: 'takeGlobalCursor', key: 'dataZoomSelect', dataZoomSelectActive: true });
  };
  return { reset, seen, watch };
}
