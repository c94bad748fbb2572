// Selectors over a plot: of the series only those with the chosen tags are shown. A series that has no tag of a
// name belongs to every choice (a reference line).

import { h } from '../dom.js';

const ALL = 'all';

/** -> {element, passes(tags), rest(tags)}: `rest` lists the tags that the selectors leave open. */
export function makeFilters(filters, onChange) {
  if (filters === undefined || filters === null) return { element: null, passes: () => true, rest: () => [] };
  if (!Array.isArray(filters)) throw new Error('"filters" is no list');
  const selects = filters.map(({ name, values }) => {
    if (!Array.isArray(values) || values.length === 0) throw new Error(`the filter ${name} needs the list values`);
    return { name, select: h('select', { onchange: onChange },
      values.map((value) => h('option', { value }, String(value))), h('option', { value: '' }, ALL)) };
  });
  const tag = (tags, name) => (tags?.[name] === undefined ? null : String(tags[name]));
  return {
    element: h('div', { class: 'filters' }, selects.map(({ name, select }) => h('label', {}, `${name} `, select))),
    passes: (tags) => selects.every(({ name, select }) =>
      select.value === '' || tag(tags, name) === null || tag(tags, name) === select.value),
    rest: (tags) => selects.filter(({ select }) => select.value === '').map(({ name }) => tag(tags, name)).filter((t) => t !== null),
  };
}
