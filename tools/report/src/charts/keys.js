// Charts by keyboard: the arrow keys go from point to point, PageUp and PageDown from curve to curve, and what stands there is shown
// and read out; Enter shows its member.

import { h } from '../dom.js';

/** now(curve) -> {series, points} for curves, or {series, points, columns} for cells in rows of `columns`; choose(i): of a point that is
 * a member, for Enter. */
export function readByKeys(holder, chart, now) {
  const said = h('span', { class: 'unseen', role: 'status' });
  holder.after(said);
  let [at, curve] = [0, 0];
  const hide = () => {
    chart.dispatchAction({ type: 'hideTip' });
    said.textContent = '';
  };
  holder.addEventListener('blur', hide);
  holder.addEventListener('keydown', (event) => {
    curve += { PageUp: -1, PageDown: 1 }[event.key] ?? 0;
    const { series, points, columns = 10, choose, curves = 1 } = now(curve);
    const turned = curves > 1 && event.key.startsWith('Page');
    const step = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: -columns, ArrowDown: columns, Home: -points, End: points }[event.key];
    if (event.key === 'Escape') hide();
    if (event.key === 'Enter' && event.target === holder && at < points) choose?.(at);
    if ((!step && !turned) || points === 0) return;
    event.preventDefault();
    at = Math.max(0, Math.min(points - 1, at + (step ?? 0)));
    chart.dispatchAction({ type: 'showTip', seriesIndex: series, dataIndex: at });
    said.textContent = holder.querySelector('.tip')?.textContent ?? '';
  });
}
