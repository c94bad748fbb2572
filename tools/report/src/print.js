// Paper: before printing, every chart is drawn again at the width of the page and twice as sharp; afterwards the
// copies go. (A canvas as it stands on the screen would be cut off or blurred.)

const SHARPER = 2;
export const PAGE_WIDTH = 660;  // CSS pixels between the margins of A4, frame taken off

const charts = [];
const preparations = [];

/** Something to be done before any printing and undone after it. */
export function onPaper(prepare, restore) {
  preparations.push({ prepare, restore });
}

/** draw(place, width, height, k) -> canvas that is ready after the current task's microtasks. */
export function onPrint(holder, height, draw) {
  charts.push({ holder, height, draw });
}

export function preparePrinting() {
  const stage = document.createElement('div');
  stage.className = 'stage';
  window.addEventListener('beforeprint', () => {
    preparations.forEach(({ prepare }) => prepare());
    document.body.append(stage);
    for (const { holder, height, draw } of charts) {
      const half = holder.closest('.figure.path') !== null;
      const width = half ? PAGE_WIDTH / 2 - 24 : PAGE_WIDTH;
      const canvas = draw(stage, width, height, SHARPER);
      queueMicrotask(() => {
        canvas.removeAttribute('style');
        canvas.className = 'paper';
        holder.append(canvas);
      });
    }
  });
  window.addEventListener('afterprint', () => {
    stage.replaceChildren();
    stage.remove();
    preparations.forEach(({ restore }) => restore());
    document.querySelectorAll('canvas.paper').forEach((canvas) => canvas.remove());
  });
}
