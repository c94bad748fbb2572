// The members of an ensemble: the block `members`, and the box at the edge of the window that shows the one that was chosen, by a
// click on it in a figure, by Enter, or by its number.

import { copyButton } from './copy.js';
import { h, inline } from '../dom.js';
import { formatShort, MISSING } from '../format.js';

let store = null;   // the members of this page
let make = null;    // a block -> {element, draw}
let box = null;     // what shows the chosen member
let origin = null;  // the element that had the focus before
const listeners = [];

export const state = { chosen: null };

/** Calls back with the member whenever another one is chosen; null: none. */
export const onChoice = (callback) => { listeners.push(callback); };

/** The block, read: {count, command(member), place(member) in the lists or -1, columns, reasons, motions}. */
export function readMembers(block) {
  if (!Array.isArray(block.columns)) throw new Error('no list "columns"');
  const count = block.index?.length ?? block.count;
  for (const { name, values } of block.columns) {
    if (values?.length !== count) throw new Error(`column ${name} has ${values?.length} values, there are ${count} members`);
  }
  const places = block.index ? new Map(block.index.map((member, i) => [member, i])) : null;
  return { count: block.count, index: block.index ?? null, columns: block.columns, reasons: block.failures ?? {}, motions: block.motions ?? {},
    command: (member) => String(block.command).replace('{}', member), place: (member) => (places ? places.get(member) ?? -1 : member) };
}

/** A block of the page: a member by its number, and those whose motion is at hand. `makeFigure`: a block -> {element, draw}. */
export function members(block, makeFigure) {
  store = readMembers(block);
  make = makeFigure;
  const number = h('input', { type: 'number', min: 0, max: store.count - 1, step: 1, value: 0, 'aria-label': `member, 0 to ${store.count - 1}` });
  const form = h('form', { class: 'filters pick', onsubmit: (event) => {
    event.preventDefault();
    if (number.reportValidity() && number.value !== '') choose(Number(number.value), number, true);
  } }, h('label', {}, 'member ', number), h('button', { type: 'submit', class: 'save' }, 'show'));
  const moving = Object.keys(store.motions).map((member) => h('button', { type: 'button', class: 'save', onclick: ({ currentTarget }) => choose(Number(member), currentTarget, true) },
    `member ${member}${tag(Number(member))}`));
  return { element: h('div', { class: 'members-block' }, (block.paragraphs ?? []).map((text) => h('p', {}, inline(text))), form,
    moving.length ? h('div', { class: 'filters' }, h('span', { class: 'words' }, 'Motions on this page:'), moving) : null) };
}

/** ", its class" where it has one. */
function tag(member) {
  const column = store.columns.find(({ names }) => names);
  const name = column?.names[column.values[store.place(member)]];
  return name === undefined ? '' : `: ${name}`;
}

/** Shows a member. `from`: where the reader was; `move`: the focus goes to the box (the keyboard chose). */
export function choose(member, from, move = false) {
  if (!store || !(member >= 0 && member < store.count)) return;
  origin = from;
  const focused = move || box?.contains(document.activeElement);
  state.chosen = member;
  if (!box) box = h('aside', { class: 'member', role: 'dialog', tabindex: -1, onkeydown: (event) => { if (event.key === 'Escape') close(); } });
  box.setAttribute('aria-label', `Member ${member}`);
  if (!box.isConnected) document.body.append(box);
  const figures = motionsOf(member);
  box.replaceChildren(...contents(member, figures));
  figures.filter(({ drawn }) => !drawn).forEach((figure) => {
    figure.drawn = true;
    Promise.resolve(figure.draw?.()).catch((error) => figure.element.replaceWith(h('p', { class: 'remark' }, `Its motion could not be shown: ${error.message}`)));
  });
  box.scrollTop = 0;
  if (focused) box.focus();
  listeners.forEach((callback) => callback(member));
}

export function close() {
  if (!box?.isConnected) return;
  box.remove();
  state.chosen = null;
  origin?.focus({ preventScroll: true });
  listeners.forEach((callback) => callback(null));
}

/** The figures of its motion, made once. */
const made = new Map();
function motionsOf(member) {
  if (!made.has(member)) made.set(member, (store.motions[member] ?? []).map((block) => ({ ...make(block), drawn: false })));
  return made.get(member);
}

function contents(member, figures) {
  const place = store.place(member);
  const step = (by) => () => choose(store.index ? store.index[place + by] : member + by, origin, true);
  const there = (by) => (store.index ? place >= 0 && store.index[place + by] !== undefined : member + by >= 0 && member + by < store.count);
  const arrow = (label, by, name) => h('button', { type: 'button', class: 'save', 'aria-label': name, title: name, disabled: !there(by), onclick: step(by) }, label);
  const head = h('div', { class: 'head' }, h('h3', { 'aria-live': 'polite' }, `Member ${member}`), arrow('‹', -1, 'the member before'), arrow('›', 1, 'the next member'),
    h('button', { type: 'button', class: 'save close', 'aria-label': 'close', title: 'close (Escape)', onclick: close }, '✕'));
  const command = store.command(member);
  return [head, ...values(member, place), h('p', { class: 'line' }, h('code', {}, command), ' ', copyButton('copy', () => command, { class: 'save' })),
    figures.length ? figures.map(({ element }) => element) : h('p', { class: 'remark' }, 'This command writes its values, its configuration and a page with its motion.')].flat();
}

function values(member, place) {
  if (place < 0) return [h('p', { class: 'remark' }, `This page has the values of one member in ${Math.round(store.count / store.index.length)}, and not of this one: the command prints them.`)];
  const reason = store.reasons[member];
  const row = ({ name, unit, values: list, names }) => {
    const value = list[place];
    const text = names ? names[value] ?? MISSING : `${formatShort(value, 6)}${unit && typeof value === 'number' ? ` ${unit}` : ''}`;
    return h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, text));
  };
  const table = (caption, columns) => (columns.length ? h('table', {}, h('caption', {}, caption), h('tbody', {}, columns.map(row))) : null);
  return [table('varied', store.columns.filter(({ varied }) => varied)),
    reason === undefined ? table('kept', store.columns.filter(({ varied }) => !varied)) : h('p', { class: 'status failed' }, `failed: ${reason}`)].filter(Boolean);
}
