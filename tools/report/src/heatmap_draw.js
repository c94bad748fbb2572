// A heat map on a canvas, in CSS pixels: names of rows and columns, cells, and below them the scale.

import { FONT } from './chart.js';
import { inkOn, sequential } from './colours.js';

const [INK, LINE, HATCH] = ['#4a525c', '#aab2bb', '#8d96a0'];
const [TEXT, SMALLEST] = [12, 8];
const TOP = 6;

const font = (size) => `${size}px ${FONT}`;

function measure(context, texts, size = TEXT) {
  context.font = font(size);
  return Math.max(0, ...texts.map((text) => context.measureText(text).width));
}

function shortened(context, text, room) {
  if (context.measureText(text).width <= room) return text;
  let kept = text;
  while (kept && context.measureText(`${kept}…`).width > room) kept = kept.slice(0, -1);
  return `${kept}…`;
}

/** Where all stands: the cells' corner and size, every how many columns and rows are named, the total height. */
function layout(context, map, width) {
  const [nx, ny] = [map.columns.length, map.rows.length];
  const names = Math.ceil(Math.min(measure(context, map.y.texts), width * 0.34));
  const left = (map.y.label ? 22 : 4) + names + 7;
  const cell = Math.min((width - left - 12) / nx, 150);
  const least = map.y.numbers ? 3 : 17;
  const tall = Math.min(200, measure(context, [map.y.label], 13) + 4);  // room for the name of the rows
  const height = Math.max(least, Math.min(28, 430 / ny), tall / ny);
  const widest = measure(context, map.columns);
  const flat = widest + 8 <= cell || map.x.numbers;
  const everyColumn = flat ? Math.max(1, Math.ceil((widest + 8) / cell)) : Math.max(1, Math.ceil(14 / cell));
  const under = flat ? 18 : Math.min(widest, 120) + 8;
  const bar = TOP + ny * height + under + (map.x.label ? 20 : 2) + 8;
  return { left, top: TOP, width: cell, height, names, flat, under, everyColumn,
    everyRow: Math.max(1, Math.ceil(15 / height)), bar, total: bar + 34 };
}

/** Draws into the canvas, `sharp` device pixels per CSS pixel -> the layout. */
export function drawMap(canvas, map, width, sharp) {
  const context = canvas.getContext('2d');
  const place = layout(context, map, width);
  [canvas.width, canvas.height] = [Math.round(width * sharp), Math.round(place.total * sharp)];
  context.scale(sharp, sharp);
  context.fillStyle = '#fff';
  context.fillRect(0, 0, width, place.total);
  const hatch = hatching(context, sharp);
  const snap = (v) => Math.round(v * sharp) / sharp;  // whole device pixels: no seams between cells
  map.rows.forEach((row, r) => row.cells.forEach((cell, c) => {
    const [x, y] = [snap(place.left + c * place.width), snap(place.top + r * place.height)];
    drawCell(context, map, cell, hatch, [x, y, snap(place.left + (c + 1) * place.width) - x, snap(place.top + (r + 1) * place.height) - y]);
  }));
  context.strokeStyle = LINE;
  context.strokeRect(place.left, place.top, map.columns.length * place.width, map.rows.length * place.height);
  drawNames(context, map, place);
  drawScale(context, map, place, width, hatch);
  return place;
}

/** Diagonal lines on white: nothing there. */
function hatching(context, sharp) {
  const size = Math.round(7 * sharp);
  const tile = document.createElement('canvas');
  [tile.width, tile.height] = [size, size];
  const pen = tile.getContext('2d');
  pen.fillStyle = '#fff';
  pen.fillRect(0, 0, size, size);
  Object.assign(pen, { strokeStyle: HATCH, lineWidth: sharp });
  for (const shift of [-size, 0, size]) {
    pen.moveTo(shift - sharp, size + sharp);
    pen.lineTo(shift + size + sharp, -sharp);
  }
  pen.stroke();
  const pattern = context.createPattern(tile, 'repeat');
  pattern.setTransform(new DOMMatrix().scale(1 / sharp));
  return pattern;
}

const part = (map, at) => (at - map.range[0]) / (map.range[1] - map.range[0]);

function drawCell(context, map, cell, hatch, [x, y, width, height]) {
  const gap = Math.min(width, height) > 16 ? 0.5 : 0;
  const rgb = Number.isFinite(cell.at) ? sequential(part(map, cell.at)) : [255, 255, 255];
  context.fillStyle = cell.missing ? hatch : `rgb(${rgb})`;
  context.fillRect(x + gap, y + gap, width - 2 * gap, height - 2 * gap);
  if (!cell.mark) return;
  let size = Math.min(TEXT, height - 2);
  while (size > SMALLEST && measure(context, [cell.mark], size) > width - 4) --size;
  context.font = font(Math.max(size, SMALLEST));
  const text = shortened(context, cell.mark, width - 3);
  Object.assign(context, { textAlign: 'center', textBaseline: 'middle' });
  if (cell.missing) {  // a clear ground for the letters
    const room = Math.min(width - 1, context.measureText(text).width + 6);
    context.fillStyle = '#fff';
    context.fillRect(x + (width - room) / 2, y + gap + 1, room, height - 2 * gap - 2);
  }
  context.fillStyle = inkOn(rgb);
  context.fillText(text, x + width / 2, y + height / 2 + 0.5);
}

function drawNames(context, map, place) {
  const { left, top, width, height } = place;
  const [right, bottom] = [left + width * map.columns.length, top + height * map.rows.length];
  Object.assign(context, { font: font(TEXT), fillStyle: INK, textAlign: 'right', textBaseline: 'middle' });
  map.rows.forEach(({ text }, r) => {
    if (r % place.everyRow === 0) context.fillText(shortened(context, text, place.names), left - 6, top + (r + 0.5) * height);
  });
  map.columns.forEach((text, c) => {
    if (c % place.everyColumn !== 0) return;
    const x = left + (c + 0.5) * width;
    if (place.flat) {
      context.textAlign = 'center';
      context.fillText(text, x, bottom + 11);
      return;
    }
    context.save();
    context.translate(x, bottom + 5);
    context.rotate(-Math.PI / 2);
    context.textAlign = 'right';
    context.fillText(shortened(context, text, place.under - 8), 0, 0.5);
    context.restore();
  });
  Object.assign(context, { font: font(13), textAlign: 'center' });
  context.fillText(map.x.label, (left + right) / 2, bottom + place.under + 9);
  context.save();
  context.translate(10, (top + bottom) / 2);
  context.rotate(-Math.PI / 2);
  context.fillText(map.y.label, 0, 0);
  context.restore();
}

/** The bar with its ticks, what it measures, and what an empty cell means. */
function drawScale(context, map, { bar }, width, hatch) {
  const [x, long] = [16, Math.min(320, width * 0.52)];
  for (let i = 0; i < long; ++i) {
    context.fillStyle = `rgb(${sequential((i + 0.5) / long)})`;
    context.fillRect(x + i, bar, Math.min(1.5, long - i), 11);
  }
  Object.assign(context, { strokeStyle: LINE, fillStyle: INK, font: font(TEXT), textAlign: 'center', textBaseline: 'middle' });
  context.strokeRect(x, bar, long, 11);
  const { at, labels } = map.value.ticks(...map.range, Math.max(2, Math.floor(long / 60)));
  at.forEach((value, i) => {
    const place = x + long * part(map, value);
    context.fillRect(place - 0.5, bar + 11, 1, labels[i] ? 4 : 2.5);
    context.fillText(labels[i], place, bar + 23);
  });
  context.textAlign = 'left';
  const beside = x + long + 12;
  context.fillText(shortened(context, map.value.label, width - beside), beside, bar + 6);
  if (!map.empty) return;
  context.fillStyle = hatch;
  context.fillRect(beside + 10, bar + 17, 18, 12);
  context.strokeRect(beside + 10, bar + 17, 18, 12);
  context.fillStyle = INK;
  context.fillText('no value', beside + 34, bar + 23.5);
}
