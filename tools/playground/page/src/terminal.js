// The commands of the program in the page: a line of words, or a text that a command reads; what they print and the pages that they write.

import { h } from '../../../report/src/dom.js';
import { fileOf, kindOf } from './state.js';

const PAGE = 'page.html';
/** Does a command write a page where it is asked to? */
const isDrawn = ([name, ...words]) => ['run', 'section', 'plan'].includes(name) || (name === 'steady' && words.some((word) => /^--vary\b/.test(word)));
const OUTPUT = ['-o', 'out', '--fresh', '--quiet'];  // of studies and ensembles

/** A command line -> its words, as a shell has them. */
export const wordsOf = (line) => [...line.matchAll(/(?:[^\s'"]+|'[^']*'|"[^"]*")+/g)].map(([word]) => word.replace(/'([^']*)'|"([^"]*)"/g, '$1$2'));

/** The words of a command line that is typed, and of a text that is a study, an ensemble or a plan. */
const typedWords = (line) => {
  const words = wordsOf(line.replace(/^\s*hamel\s+/, ''));
  return isDrawn(words) && !words.includes('--report') && !words.includes('--help') ? [...words, '--report', PAGE] : words;
};
const wordsOfText = (state) => [kindOf(state.text), fileOf(state), ...(kindOf(state.text) === 'plan' ? ['--report', PAGE] : OUTPUT)];

/** What one may ask of the system in the editor: command lines to choose from. */
function offersOf({ state, registered, system: { speed, events } = {} }) {
  const system = state.system && state.text === registered ? state.system : fileOf(state);
  return [`describe ${system} --analyse`, `describe ${system} --equations latex`, ...(speed ? [`steady ${system} --vary speed=1:8:29`] : [`steady ${system}`]),
    ...(events ?? []).slice(0, 2).map((event) => `section ${system} --event ${event} --count 20`), `run ${system} --check`, 'list systems', 'help'];
}

async function carryOut(library, words, state) {
  const { answer } = await library.call('command', { words, files: { [fileOf(state)]: state.text } });
  if (!answer.ok) return { ...answer, text: answer.mistakes.join('\n'), sections: [] };
  return { ...answer, sections: answer.pages.flatMap(({ page }) => page.sections),
    mistakes: answer.status === 2 ? answer.text.trim().split('\n').map((line) => line.replace(/^hamel: /, '')) : [] };
}

/** A text that is no system -> {text, sections, status, mistakes}. */
export const carryOutText = (library, state) => carryOut(library, wordsOfText(state), state);

/**
 * The line for commands: about() -> {state, registered, system}; draw(sections) shows a page; wait(promise) waits for the library. -> a function that offers
 * commands for the system as it is now.
 */
export function addTerminal({ library, about, draw, wait }) {
  const [form, line, offers, printed] = ['terminal', 'words', 'offers', 'printed'].map((id) => document.getElementById(id));
  form.addEventListener('submit', async (event) => {
    event.preventDefault();
    const answer = await wait(carryOut(library, typedWords(line.value), about().state));
    if (answer.ended) return;
    Object.assign(printed, { textContent: answer.text.trim() || 'done', hidden: false });
    if (answer.sections.length) await draw(answer.sections);
    printed.dataset.commands = String(1 + Number(printed.dataset.commands ?? 0));
  });
  return () => offers.replaceChildren(...offersOf(about()).map((value) => h('option', { value })));
}
