// Text to the clipboard, by a button that tells whether it got there.

import { h } from '../dom.js';

/** A button with this label that copies what `text()` returns. */
export function copyButton(label, text, attributes = { class: 'copy' }) {
  const button = h('button', { type: 'button', ...attributes, onclick: () => copyText(text(), button, label) }, label);
  return button;
}

async function copyText(text, button, label) {
  let done = true;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    done = copyBySelection(text);  // pages opened from a file may have no clipboard
  }
  button.textContent = done ? 'copied' : 'could not copy';
  setTimeout(() => { button.textContent = label; }, 1500);
}

function copyBySelection(text) {
  const area = h('textarea', { class: 'copied' });
  area.value = text;
  document.body.append(area);
  area.select();
  const done = document.execCommand('copy');
  area.remove();
  return done;
}
