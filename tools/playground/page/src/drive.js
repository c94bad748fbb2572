// A run that is driven while it is watched: keys, buttons, fingers and the sticks of a gamepad hold its inputs, and their sliders move them.

import { h } from '../../../report/src/dom.js';
import { posesOf } from './motion.js';

const LIVE = { scheme: 'lift', step: '0.005' };  // small steps of one size, unless the state has others
const LONG = '1e6';  // seconds
const ROOM = 25;  // metres
const BEHIND = 1 / 30;  // seconds: a slower picture slows the run down, so that whoever drives keeps up

/**
 * What the keys do, [{key, label, says, push: {input: part of its strength}}]: of one input left and right; of two of one unit
 * up and down for both, left and right for one against the other; of more a pair of letters each.
 */
export function keysOf(inputs) {
  const names = inputs.map(({ name }) => name);
  const both = (a, b) => Object.fromEntries([[names[0], a], [names[1], b]]);
  if (inputs.length === 1) {
    return [{ key: 'ArrowLeft', label: '←', says: `${names[0]} −`, push: { [names[0]]: -1 } }, { key: 'ArrowRight', label: '→', says: `${names[0]} +`, push: { [names[0]]: 1 } }];
  }
  if (inputs.length === 2 && inputs[0].unit === inputs[1].unit) {
    return [{ key: 'ArrowUp', label: '↑', says: 'both +', push: both(1, 1) }, { key: 'ArrowDown', label: '↓', says: 'both −', push: both(-1, -1) },
      { key: 'ArrowLeft', label: '←', says: `${names[1]} against ${names[0]}`, push: both(-0.5, 0.5) }, { key: 'ArrowRight', label: '→', says: `${names[0]} against ${names[1]}`, push: both(0.5, -0.5) }];
  }
  return names.slice(0, 4).flatMap((name, i) => [['q', -1], ['w', 1], ['a', -1], ['s', 1], ['z', -1], ['x', 1], ['o', -1], ['p', 1]].slice(2 * i, 2 * i + 2)
    .map(([key, sign]) => ({ key, label: key, says: `${name} ${sign > 0 ? '+' : '−'}`, push: { [name]: sign } })));
}

const IDLE = 0.12;  // of a stick's way: it rests

/** What the sticks of a gamepad do, axes from -1 to 1 to the right and down, as the keys do -> {input: part of its strength}. */
export function sticksOf(inputs, axes) {
  const names = inputs.map(({ name }) => name);
  const [x = 0, y = 0, ...rest] = axes.map((way) => (Math.abs(way) < IDLE ? 0 : way));
  if (inputs.length === 2 && inputs[0].unit === inputs[1].unit) return { [names[0]]: -y + x / 2, [names[1]]: -y - x / 2 };
  return Object.fromEntries(names.slice(0, 4).map((name, i) => [name, [x, -y, rest[0] ?? 0, -(rest[1] ?? 0)][i]]));
}

/** The bodies where they start, without trails, and with room on the floor to drive: poses in the corners of a large square. */
function wide(block) {
  const far = (x, y) => ([at_x, at_y, ...rest]) => [at_x + x * ROOM, at_y + y * ROOM, ...rest];
  const { forces: _, ...rest } = block;
  return { ...rest, times: [0, 1, 2], bodies: block.bodies.map((body) => ({ ...body, trail: false,
    poses: [body.poses[0], far(-1, -1)(body.poses[0]), far(1, 1)(body.poses[0])] })) };
}

/** How strong a held key is at first: half of what the range allows where there is one. */
const strengthOf = ({ range }) => (range.least !== null && range.most !== null ? (range.most - range.least) / 4 : 1);
const STRONG = { segway: 20 };  // where 1 is too weak to be of use

export class Drive {
  /** library; figure: the animation, and its block; state; system: its description; ended(reason). */
  constructor({ library, figure, block, state, system, ended }) {
    Object.assign(this, { library, figure, block, state, system, ended, held: new Set(), last: {}, on: false, time: 0 });
    this.keys = keysOf(system.inputs);
    this.strength = STRONG[system.name] ?? Math.max(...system.inputs.map(strengthOf));
    this.element = this.#panel();
    this.down = (event) => this.#key(event, true);
    this.up = (event) => this.#key(event, false);
  }

  async start() {
    const { text, parameters, inputs, options } = this.state;
    const kept = Object.fromEntries(Object.entries(options).filter(([name]) => !['until', 'rtol', 'atol'].includes(name)));
    this.base = Object.fromEntries(this.system.inputs.map(({ name }) => [name, inputs[name] ?? 0]));
    const { answer } = await this.library.call('open', { text, parameters, inputs: this.base, options: { ...LIVE, ...kept, until: LONG } });
    if (!answer.ok) return this.stop(answer.mistakes.join('\n'));
    this.on = true;
    addEventListener('keydown', this.down, true);
    addEventListener('keyup', this.up, true);
    this.figure.show(wide(this.block));
    this.figure.follow(true);
    this.#frame(performance.now());
  }

  stop(reason = '') {
    this.on = false;
    removeEventListener('keydown', this.down, true);
    removeEventListener('keyup', this.up, true);
    this.ended(reason);
  }

  #frame(before) {
    requestAnimationFrame(async (now) => {
      if (!this.on) return;
      this.time += Math.max(0, Math.min((now - before) / 1000, BEHIND));
      const { answer, numbers } = await this.library.call('advance', { time: this.time, inputs: this.#inputs() });
      if (!this.on) return;
      if (!answer.ok || answer.failure) return this.stop(answer.failure || answer.mistakes.join('\n'));
      this.element.dataset.state = JSON.stringify({ t: answer.time, ...answer.state });
      this.figure.feed(answer.time, posesOf(numbers));
      this.#frame(now);
    });
  }

  /** The inputs now: what the state has, and what is held. */
  #inputs() {
    const now = { ...this.base };
    for (const key of this.keys.filter((one) => this.held.has(one.key)))
      for (const [name, part] of Object.entries(key.push)) now[name] += part * this.strength;
    for (const pad of navigator.getGamepads?.() ?? [])
      for (const [name, part] of Object.entries(pad ? sticksOf(this.system.inputs, pad.axes) : {})) now[name] += part * this.strength;
    for (const { name, range: { least, most } } of this.system.inputs)
      now[name] = Math.max(least ?? -Infinity, Math.min(most ?? Infinity, now[name]));
    return now;
  }

  /** What an input is while nothing is held. */
  hold(name, value) { this.base[name] = value; }

  #press(key, yes) {
    if (yes) this.held.add(key); else this.held.delete(key);
    this.buttons.get(key)?.setAttribute('aria-pressed', String(yes));
  }

  #key(event, yes) {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (key === 'Escape' && yes) return this.stop();
    if (event.ctrlKey || event.metaKey || event.altKey || !this.buttons.has(key)) return;
    if (event.target.closest?.('.cm-editor, input, select')) return;
    event.preventDefault();
    event.stopPropagation();
    this.#press(key, yes);
  }

  #panel() {
    this.buttons = new Map(this.keys.map(({ key, label, says }) => {
      const button = h('button', { type: 'button', class: 'hold', 'aria-pressed': 'false', title: says, 'aria-label': says }, h('b', {}, label), ` ${says}`);
      button.addEventListener('pointerdown', (event) => {
        button.setPointerCapture(event.pointerId);
        this.#press(key, true);
      });
      for (const end of ['pointerup', 'pointercancel']) button.addEventListener(end, () => this.#press(key, false));
      return [key, button];
    }));
    const unit = this.system.inputs[0].unit;
    const strength = h('input', { type: 'number', step: 'any', min: 0, value: String(this.strength), class: 'exact', 'aria-label': 'strength of a held key',
      oninput: () => { if (Number(strength.value) >= 0) this.strength = Number(strength.value); } });
    return h('div', { class: 'drive', role: 'group', 'aria-label': 'drive' }, h('span', {}, 'Hold a key or a button, or move a stick:'), [...this.buttons.values()],
      h('label', {}, 'strength ', strength, unit && unit !== '1' ? ` ${unit}` : ''), h('button', { type: 'button', class: 'stop', onclick: () => this.stop() }, 'end (Esc)'));
  }
}
