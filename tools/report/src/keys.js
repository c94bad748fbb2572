// Charts by keyboard: the arrow keys go from point to point, and what stands there is shown and read out.

import { h } from './dom.js';

/** now() -> {series, points} for curves, or {series, points, columns} for cells in rows of `columns`. */
export function readByKeys(holder, chart, now) {
  const said = h('span', { class: 'unseen', role: 'status' });
  holder.after(said);
  let at = 0;
  const hide = () => {
    chart.dispatchAction({ type: 'hideTip' });
    said.textContent = '';
  };
  holder.addEventListener('blur', hide);
  holder.addEventListener('keydown', (event) => {
    const { series, points, columns = 10 } = now();
    const step = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: -columns, ArrowDown: columns, Home: -points, End: points }[event.key];
    if (event.key === 'Escape') hide();
    if (!step || points === 0) return;
    event.preventDefault();
    at = Math.max(0, Math.min(points - 1, at + step));
    chart.dispatchAction({ type: 'showTip', seriesIndex: series, dataIndex: at });
    said.textContent = holder.querySelector('.tip')?.textContent ?? '';
  });
}
