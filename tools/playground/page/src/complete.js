// Completions: the keys that a schema of the library has at this place, and the names that a key may have.

import mechanism from '../schema/mechanism.json';
import runs from '../schema/run.json';
import system from '../schema/system.json';
import { isConfiguration } from './state.js';

const follow = (schema, root) => (schema?.$ref ? schema.$ref.replace(/^#\//, '').split('/').reduce((at, key) => at?.[key], root) : schema);

/** The schemas of the objects that a schema allows, through lists and alternatives. */
function objectsOf(schema, root) {
  const at = follow(schema, root);
  if (!at) return [];
  const inner = [...(at.anyOf ?? []), ...(at.oneOf ?? []), ...(at.allOf ?? []), ...(at.items && !Array.isArray(at.items) ? [at.items] : [])];
  return [...(at.properties ? [at] : []), ...inner.flatMap((one) => objectsOf(one, root))];
}

/** The table that the line is in: the last [header] above, and an inline table {…} of "key = [" where the cursor is in one. */
function tableAt(before) {
  const header = [...before.matchAll(/^\s*\[\[?\s*([\w.-]+)\s*\]?\]/gm)].at(-1)?.[1];
  const since = before.slice(header ? before.lastIndexOf(`[${header}`) : 0);
  const open = (since.match(/\{/g)?.length ?? 0) > (since.match(/\}/g)?.length ?? 0);
  const key = open ? [...since.matchAll(/^\s*([\w-]+)\s*=\s*[[{]/gm)].at(-1)?.[1] : null;
  return [...(header ? header.split('.') : []), ...(key ? [key] : [])];
}

const valuesOf = (schema, root) => {
  const at = follow(schema, root);
  return [...(at?.enum ?? []), ...(at?.const !== undefined ? [at.const] : []), ...(at?.anyOf ?? at?.oneOf ?? []).flatMap((one) => valuesOf(one, root))];
};

/** A CodeMirror source; page() has the text. */
export function completions(page) {
  return (context) => {
    const before = context.state.sliceDoc(0, context.pos);
    const line = before.slice(before.lastIndexOf('\n') + 1);
    if (line.includes('#')) return null;
    const { text } = page().state;
    const root = isConfiguration(text) ? runs : /^\s*(body|joint|\[\[body)/m.test(text) ? mechanism : system;
    const tables = tableAt(before).reduce((schemas, key) => schemas.flatMap((schema) => objectsOf(schema.properties?.[key] ?? schema.additionalProperties, root)), objectsOf(root, root));
    const value = /([\w-]+)\s*=\s*(?:\[\s*)?"([^"]*)$/.exec(line);
    if (value) {
      const names = [...new Set(tables.flatMap((table) => valuesOf(table.properties[value[1]], root)))].filter((name) => typeof name === 'string');
      return names.length ? { from: context.pos - value[2].length, options: names.map((label) => ({ label, type: 'enum' })) } : null;
    }
    const word = /(?:^|[{,])\s*([\w-]*)$/.exec(line);
    if (!word || (!word[1] && !context.explicit)) return null;
    const keys = new Map(tables.flatMap((table) => Object.entries(table.properties).map(([label, of]) =>
      [label, { label, type: 'property', info: follow(of, root)?.description, apply: `${label} = ` }])));
    return keys.size ? { from: context.pos - word[1].length, options: [...keys.values()] } : null;
  };
}
