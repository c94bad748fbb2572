// A click on a point of a chart that is a member chooses it; a ring marks the chosen one, whoever chose it.

import { h } from '../dom.js';
import { choose, onChoice, state } from '../blocks/members.js';

const NEAR = { dots: 16, curve: 40 };  // pixels
const TWICE = 250;                     // milliseconds: two clicks show the whole chart again, and choose nothing

/** A ring over the chart at the places `where(member)` -> [x, y] or [x, y, width, height] in pixels, or null; -> {follow()} to place it again. */
export function makeRing(holder, where) {
  const ring = h('div', { class: 'ring', hidden: true });
  const follow = () => {
    const at = state.chosen === null ? null : where(state.chosen);
    ring.hidden = !at;
    if (!at) return;
    if (!ring.isConnected) holder.append(ring);
    const [x, y, width = 14, height = 14] = at;
    ring.classList.toggle('round', at.length === 2);
    ring.style.cssText = `left:${x - width / 2}px;top:${y - height / 2}px;width:${width}px;height:${height}px`;
  };
  onChoice(follow);
  return { follow };
}

/** Curves whose points are members: click and ring; -> choose(member) for the keyboard. */
export function choosable(holder, chart, curves) {
  const pixel = ([x, y]) => chart.convertToPixel({ xAxisIndex: 0, yAxisIndex: 0 }, [x, y]);
  const inside = (at) => chart.containPixel({ gridIndex: 0 }, at);
  holder.classList.add('choosable');
  let waiting = 0;
  holder.addEventListener('dblclick', () => clearTimeout(waiting));
  chart.getZr().on('click', ({ offsetX, offsetY, event }) => {
    clearTimeout(waiting);
    if (event?.detail > 1) return;
    let [best, distance] = [null, Infinity];
    for (const { points, show, dots } of curves) {
      if (!show) continue;
      for (const point of points) {
        if (point[0] === null || point[1] === null) continue;
        const [x, y] = pixel(point);
        const away = Math.hypot(x - offsetX, y - offsetY);
        if (away < Math.min(distance, dots ? NEAR.dots : NEAR.curve)) [best, distance] = [point[2], away];
      }
    }
    if (best !== null && best !== undefined) waiting = setTimeout(() => choose(best, holder), TWICE);
  });
  const { follow } = makeRing(holder, (member) => {
    const point = curves.filter(({ show }) => show).flatMap(({ points }) => points).find((p) => p[2] === member && p[0] !== null && p[1] !== null);
    const at = point && pixel(point);
    return at && inside(at) ? at : null;
  });
  chart.on('finished', follow);
  return (member) => choose(member, holder, true);
}
