// Paper: before printing, what must be drawn for the width of the page is drawn again; afterwards for the screen.

const preparations = [];

/** Something to be done before any printing and undone after it. */
export function onPaper(prepare, restore) {
  preparations.push({ prepare, restore });
}

/** Does what is drawn for paper, whatever the screen shows. */
export function onPaperFor(draw) {
  const { classList } = document.documentElement;
  const already = classList.contains('paper');
  classList.add('paper');
  try {
    draw();
  } finally {
    classList.toggle('paper', already);
  }
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
