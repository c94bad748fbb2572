// The page: an editor, sliders, the motion beside them.

import '../../../report/src/style.css';
import '../../../report/src/figures.css';
import '../../../report/src/print.css';
import './playground.css';
import { animation, warm } from '../../../report/src/stage/animation.js';
import { h, inline } from '../../../report/src/dom.js';
import { Controls } from './controls.js';
import { Drive } from './drive.js';
import { Library } from './library.js';
import { mistakesOf } from './mistakes.js';
import { alike, motionOf } from './motion.js';
import { commandOf, fileOf, fragmentOf, kindOf, liveState, pythonOf, stateOf, stateOfFragment } from './state.js';
import { addTerminal, carryOutText } from './terminal.js';

const FIRST = 'bicycle';
const [TYPED, CALM, SLOW] = [250, 350, 400];  // milliseconds: until a text is run, until figures are drawn, until a run is said to take long

const $ = (id) => document.getElementById(id);
const library = new Library(globalThis.hamelSource);
const page = { state: stateOf(FIRST, ''), registered: new Map(), controls: null, editor: null, drive: null, catalogue: null,
  shown: null, figures: null, running: false, wanted: null, timer: 0, calm: 0 };

/** The text of a registered system. */
async function textOf(name) {
  if (!page.registered.has(name)) {
    const { answer } = await library.call('text', { name });
    if (!answer.ok) throw new Error(answer.mistakes.join('\n'));
    page.registered.set(name, answer.text);
  }
  return page.registered.get(name);
}
const registered = () => page.registered.get(page.state.system);

// ---- runs: one at a time, the last one wanted next ----------------------------------------------------------------------

function run() {
  page.wanted = page.state;
  if (!page.running) work();
}

/** Waits for the library; where that takes long, the page says so. */
async function wait(promise) {
  const slow = setTimeout(() => { document.body.dataset.slow = 'true'; }, SLOW);
  try {
    return await promise;
  } finally {
    clearTimeout(slow);
    delete document.body.dataset.slow;
  }
}

async function work() {
  page.running = true;
  while (page.wanted) {
    const state = page.wanted;
    page.wanted = null;
    const { text, options, parameters, inputs } = state;
    const isRun = kindOf(text) === 'run';
    const { answer, numbers } = await wait(isRun ? library.call('run', { text, origin: fileOf(state), options, parameters, inputs }) : carryOutText(library, state).then((answer) => ({ answer })))
      .catch((error) => ({ answer: { ok: false, mistakes: [error.message] } }));
    if (!page.wanted || answer.ok) (isRun ? show : showOther)(answer, numbers, state);
  }
  page.running = false;
}

/** What is wrong with the text, and where. */
function tellMistakes(messages, state) {
  const mistakes = mistakesOf(messages, fileOf(state));
  document.body.classList.toggle('mistaken', mistakes.length > 0);
  $('mistakes').replaceChildren(...mistakes.map(({ line, column, text }) => h('li', {}, line ? h('button', { type: 'button', onclick: () => page.editor?.focus(line) },
    `line ${line}${column ? `, column ${column}` : ''}`) : null, line ? ' ' : null, text)));
  page.mistakes = mistakes;
  page.editor?.mark(mistakes);
  clearTimeout(page.calm);
}

/** The page of a study, an ensemble or a plan. */
async function showOther(answer, _, state) {
  if (answer.ended) return;
  tellMistakes(answer.mistakes, state);
  if (answer.mistakes.length) return done();
  page.shown?.figure.dispose();
  page.shown = null;
  page.controls?.clear();
  $('motion').replaceChildren(h('p', { class: 'remark' }, 'Its page is below.'));
  for (const id of ['verdict', 'facts', 'notes']) $(id).replaceChildren();
  $('drive').hidden = true;
  await drawSections(answer.sections);
  done();
}

function show(answer, numbers, state) {
  if (answer.ended) return;
  tellMistakes(answer.ok ? [] : answer.mistakes, state);
  if (!answer.ok) return done();
  showMotion(motionOf(answer.motion, numbers));
  const { status, text } = answer.verdict;
  $('verdict').className = `verdict ${answer.failure ? 'failed' : status}`;
  $('verdict').replaceChildren(h('span', {}, inline(answer.failure ? `Ended at t = ${answer.time.toPrecision(6)} s: ${answer.failure}` : text)));
  $('facts').textContent = `${answer.method} · ${answer.steps_in_words} · ${answer.steps} steps in ${(1e3 * answer.seconds).toPrecision(3)} ms`;
  $('notes').replaceChildren(...answer.notes.map((note) => h('p', { class: 'remark' }, inline(note))));
  page.system = { ...answer.system, options: answer.options };
  page.controls?.show(page.system, page.state);
  page.offer?.();
  $('drive').hidden = answer.system.inputs.length === 0 || !page.shown;
  page.calm = setTimeout(() => drawFigures(), CALM);
  done();
}

function done() {
  document.documentElement.dataset.ready = 'true';
  document.body.dataset.runs = String(1 + Number(document.body.dataset.runs ?? 0));
}

function showMotion(block) {
  const before = page.shown;
  if (before && alike(before.block, block) && JSON.stringify(before.block.bodies.map((b) => b.shapes)) === JSON.stringify(block.bodies.map((b) => b.shapes))) {
    before.block = block;
    before.figure.show(block);
    return;
  }
  before?.figure.dispose();
  page.shown = null;
  if (!block) {
    $('motion').replaceChildren(h('p', { class: 'remark' }, 'This system has no drawing: its figures are below.'));
    return;
  }
  const figure = animation(block);
  $('motion').replaceChildren(figure.element);
  page.shown = { block, figure };
  figure.draw();
  figure.play();
  requestAnimationFrame(() => { document.documentElement.dataset.first ??= Math.round(performance.now()); });
}

/** The motion of a registered system as it was when this page was built, while the library is on its way. */
async function showStored(name) {
  const early = () => !page.shown && !document.documentElement.dataset.ready;
  if (!early()) return;
  const stored = await library.source.stored(name).catch(() => null);
  if (!stored || !early()) return;
  $('text').textContent = stored.text;
  showMotion(motionOf(stored.motion, new Float32Array(Uint8Array.from(atob(stored.numbers), (c) => c.charCodeAt(0)).buffer)));
}

/** Charts: their code comes when the first motion is there. */
async function drawFigures() {
  const { answer } = await library.call('figures');
  if (answer.ok && !page.running) await drawSections(answer.sections);
}

async function drawSections(sections) {
  const { draw } = await import('./figures.js');
  page.figures?.();
  page.figures = draw($('figures'), sections);
}

// ---- what changes the state ---------------------------------------------------------------------------------------------

async function changed({ quickly = true } = {}) {
  if (page.drive) page.drive.stop();
  clearTimeout(page.timer);
  page.timer = setTimeout(run, quickly ? 0 : TYPED);
  await tell();
}

/** The state as a command, in the list and in the address. */
async function tell() {
  $('command').textContent = commandOf(page.state, registered());
  $('system').value = page.state.text === registered() ? page.state.system : '';
  page.offer?.();
  history.replaceState(null, '', await fragmentOf(page.state, registered()));
}

function typed(text) {
  page.state = { ...page.state, text };
  changed({ quickly: false });
}

function moved(part, name, value) {
  const { [name]: _, ...rest } = page.state[part];
  page.state = { ...page.state, [part]: value === null ? rest : { ...rest, [name]: value } };
  if (part !== 'inputs' || !page.drive) return changed();
  page.drive.hold(name, value ?? 0);  // the run that is driven has it at once
  page.controls.show(page.system, page.state);
  tell();
}

async function choose(name) {
  page.state = stateOf(name, await textOf(name));
  page.editor?.show(page.state.text);
  changed();
}

/** The state that the address has; that of the first system where it has none. */
async function read() {
  const state = (location.hash ? null : liveState()) ?? await stateOfFragment(location.hash).catch((error) => {
    $('mistakes').replaceChildren(h('li', {}, error.message));
    return null;
  }) ?? { system: FIRST, options: {}, parameters: {}, inputs: {} };
  if (state.text === undefined) {
    showStored(state.system);
    state.text = await textOf(state.system).catch(async () => {
      state.system = FIRST;
      return textOf(FIRST);
    });
  } else if (state.system) await textOf(state.system).catch(() => { state.system = ''; });
  page.state = state;
  $('system').value = state.text === registered() ? state.system : '';
  page.editor?.show(state.text);
  $('command').textContent = commandOf(state, registered());
}

// ---- the parts that come behind the first motion ------------------------------------------------------------------------

async function addEditor() {
  const { completions, makeEditor } = await import('./editing.js');
  $('text').hidden = true;
  page.editor = makeEditor($('editor'), typed, completions(() => page));
  page.editor.show(page.state.text);
  page.editor.mark(page.mistakes ?? []);
}

function fillSystems(systems) {
  const group = (label, list) => h('optgroup', { label }, list.map(({ name, summary }) => h('option', { value: name, title: summary }, name.replaceAll('_', ' '))));
  $('system').replaceChildren(group('Mechanisms by parts', systems.filter((s) => s.mechanism)), group('Systems', systems.filter((s) => !s.mechanism)),
    h('option', { value: '', hidden: true }, 'a system of your own'));
  $('system').value = page.state.text === registered() ? page.state.system : '';
  $('system').addEventListener('change', () => choose($('system').value));
}

function addButtons() {
  const say = (text) => {
    $('said').textContent = text;
    setTimeout(() => { $('said').textContent = ''; }, 4000);
  };
  const copy = (text, what) => navigator.clipboard.writeText(text).then(() => say(`${what} copied`), () => say('this browser does not let a page copy'));
  $('share').addEventListener('click', async () => copy(`${location.href.replace(/#.*/, '')}${await fragmentOf(page.state, registered())}`, 'address'));
  $('copy').addEventListener('click', () => copy($('command').textContent, 'command'));
  $('python').addEventListener('click', () => copy(pythonOf(page.state, registered()), 'Python'));
  $('download').addEventListener('click', () => {
    const link = h('a', { download: fileOf(page.state), href: URL.createObjectURL(new Blob([page.state.text], { type: 'application/toml' })) });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
  $('drive').addEventListener('click', () => {
    const { inputs } = page.state;
    page.drive = new Drive({ library, figure: page.shown.figure, block: page.shown.block, state: page.state, system: page.system, ended: (reason) => {
      page.drive?.element.remove();
      page.drive = null;
      $('drive').disabled = false;
      page.shown?.figure.show(page.shown.block);
      if (inputs !== page.state.inputs) run();
      say(reason);
      if (reason) $('notes').replaceChildren(h('p', { class: 'remark' }, reason));
    } });
    $('drive').disabled = true;
    $('motion').append(page.drive.element);
    page.drive.start();
  });
  page.offer = addTerminal({ library, about: () => ({ state: page.state, registered: registered(), system: page.system }), draw: drawSections, wait });
  page.offer();
  $('stop').addEventListener('click', () => {
    library.restart();
    delete document.body.dataset.slow;
  });
}

async function begin() {
  const state = read();
  warm();  // while the library is compiled and runs for the first time
  await state;
  $('text').textContent = page.state.text;
  run();
  addButtons();
  $('guide').hidden = !/\/playground\/(\w+\.html)?$/.test(location.pathname);  // in the site
  document.body.append(h('span', { id: 'light', class: 'light', hidden: true }));
  const { answer } = await library.call('catalogue');
  page.catalogue = answer;
  fillSystems(answer.systems);
  $('version').textContent = `hamel ${answer.version} (${answer.git})`;
  page.controls = new Controls($('controls'), answer.options, moved);
  if (page.system) page.controls.show(page.system, page.state);
  addEventListener('hashchange', async () => {
    await read();
    run();
  });
  await addEditor();
  document.documentElement.dataset.complete = 'true';
}

begin().catch((error) => {
  $('mistakes').replaceChildren(h('li', {}, `This page could not start: ${error.message}`));
  document.documentElement.dataset.ready = 'true';
});
