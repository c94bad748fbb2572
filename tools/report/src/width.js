// Widths on the screen: of texts, and of elements as they change.

export const FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Noto Sans', 'DejaVu Sans', sans-serif";  // (in an attribute of the SVG)

/** Width of a text on the screen, in pixels. */
const pen = document.createElement('canvas').getContext('2d');
export function widthOf(text, size = 12) {
  pen.font = `${size}px ${FONT}`;
  return pen.measureText(text).width;
}

/** The widest of the texts. */
export const widest = (texts, size) => Math.max(0, ...texts.map((text) => widthOf(text, size)));

/** Calls back, once a frame, when the element has another width -> a function that ends this. */
export function followWidth(element, callback) {
  let last = element.clientWidth;
  const observer = new ResizeObserver(() => requestAnimationFrame(() => {
    const width = element.clientWidth;
    if (width === last || width === 0 || matchMedia('print').matches) return;
    last = width;
    callback();
  }));
  observer.observe(element);
  return () => observer.disconnect();
}
