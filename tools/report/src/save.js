// Files that a reader saves from the page: figures as SVG and PNG, their data as CSV.

export const SHARPER = 3;  // pixels of a PNG per pixel of the page

function save(name, blob) {
  const link = Object.assign(document.createElement('a'), { download: name, href: URL.createObjectURL(blob) });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** The SVG on white paper or on none, the variables of the style sheet replaced by the values that they have in print. */
export function plainSvg(svg, transparent = false) {
  const print = getComputedStyle(document.getElementById('light'));
  const drawn = svg.replace(/var\((--[\w-]+)\)/g, (_, name) => print.getPropertyValue(name).trim());
  return transparent ? drawn : drawn.replace(/(<svg[^>]*>)/, '$1<rect width="100%" height="100%" fill="#fff"/>');
}

export const saveSvg = (name, svg) => save(`${name}.svg`, new Blob([plainSvg(svg)], { type: 'image/svg+xml' }));

export async function savePng(name, svg) {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(plainSvg(svg))}`;
  await image.decode();
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [image.naturalWidth * SHARPER, image.naturalHeight * SHARPER];
  canvas.getContext('2d').drawImage(image, 0, 0, canvas.width, canvas.height);
  canvas.toBlob((blob) => save(`${name}.png`, blob), 'image/png');
}

export const saveData = (name, csv) => save(`${name}.csv`, new Blob([csv], { type: 'text/csv' }));

/** Columns of different length side by side -> CSV; heads are quoted. */
export function columnsToCsv(columns) {
  const quoted = (text) => `"${String(text).replaceAll('"', '""')}"`;
  const rows = Math.max(0, ...columns.map(({ values }) => values.length));
  const lines = [columns.map(({ name }) => quoted(name)).join(',')];
  for (let i = 0; i < rows; ++i) lines.push(columns.map(({ values }) => (typeof values[i] === 'string' ? quoted(values[i]) : values[i] ?? '')).join(','));
  return `${lines.join('\n')}\n`;
}
