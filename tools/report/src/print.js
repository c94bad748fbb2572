// Paper: before printing, what must be drawn for the width of the page is drawn again; afterwards for the screen.

const preparations = [];

/** Something to be done before any printing and undone after it. */
export function onPaper(prepare, restore) {
  preparations.push({ prepare, restore });
}

export function preparePrinting() {
  addEventListener('beforeprint', () => {
    document.documentElement.classList.add('paper');
    preparations.forEach(({ prepare }) => prepare());
  });
  addEventListener('afterprint', () => {
    document.documentElement.classList.remove('paper');
    preparations.forEach(({ restore }) => restore());
  });
}
