// The record of a run as keys and values, nested keys joined by dots, with its JSON to copy.

import { copyButton } from './copy.js';
import { h } from '../dom.js';
import { formatShort, formatValue, MISSING } from '../format.js';

/** What a reader looks for; the rest is folded away. */
const SOUGHT = /^(system|group|scheme|s|retraction|solver|compose|tolerance|rtol|atol|step|until|status|reason|steps|time|notes|git|version|host|title)$|^(parameters|start|diagnostics|timing|failure|study)\b/;

export function record(block) {
  const values = block.record;
  if (values === null || typeof values !== 'object') throw new Error('no object "record"');
  const copy = copyButton('copy JSON', () => JSON.stringify(values, null, 2));
  const entries = flatten(values);
  const sought = entries.filter(([key, value]) => SOUGHT.test(key) && value !== null && !isEmpty(value) && value !== 'none');
  const title = block.title ?? ['system', 'scheme', 'retraction', 'solver'].map((key) => values[key])
    .filter((part) => typeof part === 'string').join(', ');
  const caption = title ? `Record of the run: ${title}` : 'Record of the run';
  const rest = entries.filter((entry) => !sought.includes(entry));
  const element = h('div', { class: 'record-block' }, copy, entryTable(caption, sought), rest.length === 0 ? null :
    h('details', {}, h('summary', {}, `${rest.length} more entries`), entryTable('Further entries', rest)));
  return { element };
}

const isEmpty = (value) => value === '' || (Array.isArray(value) && value.length === 0);

function entryTable(caption, entries) {
  return h('table', {}, h('caption', {}, caption), h('tbody', {}, entries.map(([key, value]) => {
    const dot = key.lastIndexOf('.') + 1;
    const status = key === 'status' ? `status ${value === 'ok' ? 'ok' : 'failed'}` : null;
    const text = isEmpty(value) ? MISSING : formatValue(value, formatShort);
    return h('tr', {}, h('th', { scope: 'row' }, h('span', { class: 'parent' }, breakable(key.slice(0, dot))), breakable(key.slice(dot))),
      h('td', { title: typeof value === 'number' ? String(value) : null }, status ? h('span', { class: status }, text) : text));
  })));
}

/** A long name may break after its dots and underscores. */
const breakable = (name) => name.split(/(?<=[._])/).flatMap((part, i) => (i ? [h('wbr'), part] : [part]));

function flatten(object, prefix = '') {
  return Object.entries(object).flatMap(([key, value]) => {
    const nested = value !== null && typeof value === 'object' && !Array.isArray(value);
    return nested ? flatten(value, `${prefix}${key}.`) : [[prefix + key, value]];
  });
}
