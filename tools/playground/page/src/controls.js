// Sliders of a system: the options of its run, its parameters, its inputs. What is moved stands beside the text and goes first.

import { h } from '../../../report/src/dom.js';

const STEPS = 400;
// The options that have a slider: between which values, and whether by decades.
const SLIDERS = {
  until: { low: 1, high: 60 },
  speed: { low: 0, high: 10 },
  step: { low: 1e-4, high: 0.2, log: true },
  rtol: { low: 1e-13, high: 1e-2, log: true },
};
const CHOICES = ['scheme', 'retraction'];

/** Between which values a slider moves a parameter or an input. */
export function reachOf(value, { least, most, open }) {
  const away = (end, step) => (open ? end + step : end);
  const size = Math.abs(value) || 1;
  let low = value > 0 ? 0 : value < 0 ? 3 * value : -1;
  let high = value > 0 ? 3 * value : value < 0 ? 0 : 1;
  if (least !== null) low = Math.max(low, away(least, size / 50));
  if (most !== null) high = Math.min(high, away(most, -size / 50));
  if (least !== null && most !== null) [low, high] = [away(least, (most - least) / 1000), away(most, (least - most) / 1000)];
  if (low > high) [low, high] = [Math.min(value, low, high), Math.max(value, low, high)];
  return { low: Math.min(low, value), high: Math.max(high, value) };
}

/** The options that neither a slider nor a choice has: those of `hamel live`. */
const othersOf = ({ options }) => Object.entries(options).filter(([name]) => !(name in SLIDERS) && !CHOICES.includes(name));

const back = (name, take) => h('button', { type: 'button', class: 'back', title: `${name} as in the text`, 'aria-label': `${name} as in the text`, onclick: take }, '×');

/** {name, unit, meaning, low, high, log, value or null}, change(value or null): a row; null takes what is moved back. */
function slider({ name, unit, meaning, low, high, log, value, moved }, change) {
  const toBar = (x) => Math.round(STEPS * (log ? Math.log(x / low) / Math.log(high / low) : (x - low) / (high - low)));
  const fromBar = (k) => Number((log ? low * (high / low) ** (k / STEPS) : low + ((high - low) * k) / STEPS).toPrecision(log ? 3 : 4));
  const clamped = (x) => Math.max(0, Math.min(STEPS, x));
  const bar = h('input', { type: 'range', min: 0, max: STEPS, 'aria-label': unit && unit !== '1' ? `${name}, ${unit}` : name, title: meaning || null });
  const exact = h('input', { type: 'number', step: 'any', class: 'exact', 'aria-label': `${name}, as a number` });
  const row = h('div', { class: 'slider', 'data-name': name, title: meaning || null },
    h('span', { class: 'name' }, name, unit && unit !== '1' ? h('span', { class: 'unit' }, ` ${unit}`) : null), bar, exact, back(name, () => change(null)));
  const show = (x, isMoved) => {
    row.classList.toggle('moved', isMoved);
    if (document.activeElement !== bar) bar.value = x === null ? 0 : clamped(toBar(x));
    if (document.activeElement !== exact) exact.value = x === null ? '' : String(Number(x.toPrecision(6)));
    row.classList.toggle('unset', x === null);
  };
  bar.addEventListener('input', () => {
    exact.value = String(fromBar(Number(bar.value)));
    row.classList.add('moved');
    change(fromBar(Number(bar.value)));
  });
  exact.addEventListener('change', () => { if (exact.value !== '' && Number.isFinite(Number(exact.value))) change(Number(exact.value)); });
  show(value, moved);
  return { element: row, show };
}

function choice({ name, meaning, names, value }, change) {
  const select = h('select', { 'aria-label': name, title: meaning }, h('option', { value: '' }, 'as in the text'), names.map((one) => h('option', { value: one }, one)));
  const show = (now) => { select.value = now ?? ''; };
  select.addEventListener('change', () => change(select.value || null));
  show(value);
  return { element: h('label', { class: 'choice', 'data-name': name }, h('span', { class: 'name' }, name), select), show };
}

/** change(part, name, value or null): part is options (texts), parameters (lists) or inputs (numbers). */
export class Controls {
  constructor(holder, options, change) {
    Object.assign(this, { holder, options, change, rows: new Map(), key: '' });
  }

  /** The rows of a system, whose values are those of the run that is shown; made anew where it has others. */
  show(system, state) {
    const key = JSON.stringify([system.name, system.parameters.map(({ name, value, unit }) => [name, value.length, unit]), system.inputs.map(({ name }) => name), system.speed, state.text, othersOf(state)]);
    if (key !== this.key) this.#build(system, state);
    this.key = key;
    this.current = new Map(system.parameters.map(({ name, value }) => [name, value]));
    for (const { name, value } of system.parameters)
      value.forEach((x, i) => this.rows.get(`parameters ${name} ${i}`)?.show(x, Object.hasOwn(state.parameters, name)));
    for (const { name } of system.inputs)
      this.rows.get(`inputs ${name}`)?.show(state.inputs[name] ?? 0, Object.hasOwn(state.inputs, name));
    for (const name of Object.keys(SLIDERS)) {
      const given = state.options[name];
      const ran = system.options[name];
      this.rows.get(`options ${name}`)?.show(ran === '' ? null : Number(ran), given !== undefined);
    }
    for (const name of CHOICES) this.rows.get(`options ${name}`)?.show(state.options[name]);
  }

  /** Nothing to move. */
  clear() {
    this.rows.clear();
    this.key = '';
    this.holder.replaceChildren();
  }

  #build(system, state) {
    this.rows.clear();
    const add = (key, row) => {
      this.rows.set(key, row);
      return row.element;
    };
    const of = (name) => this.options.find((option) => option.name === name) ?? { unit: '', meaning: '', names: [] };
    const option = (name, about) => add(`options ${name}`, slider({ name, unit: of(name).unit, meaning: of(name).meaning, ...about,
      value: null, moved: false }, (value) => this.change('options', name, value === null ? null : String(value))));
    const run = [...Object.entries(SLIDERS).filter(([name]) => name !== 'speed' || system.speed).map(([name, about]) => option(name, about)),
      ...othersOf(state).map(([name, value]) => h('div', { class: 'slider moved other', 'data-name': name, title: of(name).meaning || null }, h('span', { class: 'name' }, name), h('code', {}, value), back(name, () => this.change('options', name, null)))),
      h('div', { class: 'choices' }, CHOICES.map((name) => add(`options ${name}`, choice({ ...of(name), value: state.options[name] }, (value) => this.change('options', name, value)))))];
    const parameters = system.parameters.flatMap(({ name, value, unit, meaning, range }) => value.map((x, i) =>
      add(`parameters ${name} ${i}`, slider({ name: value.length > 1 ? `${name}[${i + 1}]` : name, unit, meaning, value: x, moved: false, ...reachOf(x, range) }, (given) => {
        if (given === null) return this.change('parameters', name, null);
        const entries = [...this.current.get(name)];
        entries[i] = given;
        this.current.set(name, entries);
        this.change('parameters', name, entries);
      }))));
    const inputs = system.inputs.map(({ name, unit, meaning, range }) => {
      const bounded = range.least !== null && range.most !== null;
      return add(`inputs ${name}`, slider({ name, unit, meaning, value: state.inputs[name] ?? 0, moved: false, ...reachOf(0, range),
        ...(bounded ? {} : { low: -5, high: 5 }) }, (value) => this.change('inputs', name, value)));
    });
    const group = (title, rows) => (rows.length ? h('fieldset', { class: 'group' }, h('legend', {}, title), rows) : null);
    this.holder.replaceChildren(...[group('Run', run), group('Inputs', inputs), group('Parameters', parameters)].filter(Boolean));
  }
}
