// The record of a run as keys and values, nested keys joined by dots, with its JSON to copy.

import { h } from './dom.js';
import { formatShort, formatValue } from './format.js';

export function record(block) {
  const values = block.record;
  if (values === null || typeof values !== 'object') throw new Error('no object "record"');
  const copy = h('button', { type: 'button', class: 'copy', onclick: () => copyText(values, copy) }, 'copy JSON');
  const rows = flatten(values).map(([key, value]) => {
    const dot = key.lastIndexOf('.') + 1;
    const status = key === 'status' ? `status ${value === 'ok' ? 'ok' : 'failed'}` : null;
    const text = formatValue(value, formatShort) || '–';
    return h('tr', {}, h('th', { scope: 'row' }, 
      h('span', { class: 'parent' }, breakable(key.slice(0, dot))), breakable(key.slice(dot))),
      h('td', { title: typeof value === 'number' ? String(value) : null },
        status ? h('span', { class: status }, text) : text));
  });
  const title = block.title ?? ['system', 'scheme', 'retraction', 'solver'].map((key) => values[key])
    .filter((part) => typeof part === 'string').join(', ');
  const element = h('div', { class: 'record-block' }, copy,
    h('table', {}, h('caption', {}, title ? `Record of the run: ${title}` : 'Record of the run'),
      h('tbody', {}, rows)));
  return { element };
}

/** A long name may break after its dots and underscores. */
const breakable = (name) => name.split(/(?<=[._])/).flatMap((part, i) => (i ? [h('wbr'), part] : [part]));

function flatten(object, prefix = '') {
  return Object.entries(object).flatMap(([key, value]) => {
    const nested = value !== null && typeof value === 'object' && !Array.isArray(value);
    return nested ? flatten(value, `${prefix}${key}.`) : [[prefix + key, value]];
  });
}

async function copyText(values, button) {
  const text = JSON.stringify(values, null, 2);
  let done = true;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    done = copyBySelection(text);  // pages opened from a file may have no clipboard
  }
  button.textContent = done ? 'copied' : 'could not copy';
  setTimeout(() => { button.textContent = 'copy JSON'; }, 1500);
}

function copyBySelection(text) {
  const area = h('textarea', { class: 'stage' });
  area.value = text;
  document.body.append(area);
  area.select();
  const done = document.execCommand('copy');
  area.remove();
  return done;
}
