// Paragraphs and verdicts.

import { h, inline } from '../dom.js';

const VERDICTS = { ok: ['✓', 'OK'], failed: ['✕', 'Failed'], note: ['i', 'Note'] };

export function text(block) {
  if (!Array.isArray(block.paragraphs)) throw new Error('no list "paragraphs"');
  return { element: h('div', { class: 'text' }, block.paragraphs.map((p) => h('p', {}, inline(p)))) };
}

export function verdict(block) {
  const known = Object.hasOwn(VERDICTS, block.status) ? block.status : 'note';
  const [sign, word] = VERDICTS[known];
  return {
    element: h('div', { class: `verdict ${known}`, role: 'note' },
      h('span', { class: 'sign', 'aria-hidden': 'true' }, sign),
      h('div', {}, h('span', { class: 'word' }, word), ' ', inline(block.text))),
  };
}
