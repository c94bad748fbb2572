// Paper: before printing, what must be drawn for the width of the page is drawn again; afterwards for the screen.

const preparations = [];  // of what is drawn

/** Something to be done before any printing and undone after it -> a function that ends this. */
export function onPaper(prepare, restore) {
  const one = { prepare, restore };
  preparations.push(one);
  return () => { preparations.splice(preparations.indexOf(one), 1); };
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
