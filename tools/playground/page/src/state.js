// What the page shows, as the fragment of its address and as a command line.
//
// {system: name or '', text, options: {name: text}, parameters: {name: numbers}, inputs: {name: number}}

const EMPTY = { options: {}, parameters: {}, inputs: {} };
export const stateOf = (system, text) => ({ system, text, ...structuredClone(EMPTY) });

const base64url = (bytes) => btoa(String.fromCharCode(...bytes)).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
const fromBase64url = (text) => Uint8Array.from(atob(text.replaceAll('-', '+').replaceAll('_', '/')), (c) => c.charCodeAt(0));
const through = async (bytes, stream) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());

const isPlain = (state) => ['options', 'parameters', 'inputs'].every((part) => Object.keys(state[part]).length === 0);

/** The fragment: the name of a registered system alone where that is all, else everything, compressed. */
export async function fragmentOf(state, registered) {
  if (state.system && state.text === registered && isPlain(state)) return `#${state.system}`;
  const { system, text, options, parameters, inputs } = state;
  const kept = { system, ...(text === registered ? {} : { text }), options, parameters, inputs };
  return `#~${base64url(await through(new TextEncoder().encode(JSON.stringify(kept)), new CompressionStream('deflate-raw')))}`;
}

/** The state of a fragment, its text left out where it is that of its system; null of an empty one. Throws where it is damaged. */
export async function stateOfFragment(fragment) {
  const text = decodeURIComponent(fragment.replace(/^#/, ''));
  if (!text) return null;
  if (!text.startsWith('~')) return { system: text, ...structuredClone(EMPTY) };
  try {
    const state = JSON.parse(new TextDecoder().decode(await through(fromBase64url(text.slice(1)), new DecompressionStream('deflate-raw'))));
    return { ...structuredClone(EMPTY), ...state, system: String(state.system ?? '') };
  } catch {
    throw new Error('The address of this page is damaged: what stands behind # was cut or changed.');
  }
}

/** What `hamel live` put into the page: {system} or {text}; null in other pages. */
export function liveState() {
  const given = document.getElementById('live')?.textContent;
  return given ? { system: '', ...structuredClone(EMPTY), ...JSON.parse(given) } : null;
}

/** Is it the configuration of a run, not a system? */
export const isConfiguration = (text) => /^\s*system\s*=/m.test(text.split(/^\s*\[/m)[0]);

/** The command that reads a text. */
export const kindOf = (text) => (/^\s*\[\[system\]\]/m.test(text) ? 'study' : /^\s*\[vary\b/m.test(text) ? 'ensemble' : /^\s*\[to\]/m.test(text) ? 'plan' : 'run');

/** The name of its file. */
export function fileOf(state) {
  const name = /^\s*name\s*=\s*["']([^"']+)["']/m.exec(state.text)?.[1] || /^\s*system\s*=\s*["']([^"']+?)(\.toml)?["']/m.exec(state.text)?.[1] || state.system || 'system';
  const stem = name.toLowerCase().replace(/[^a-z0-9]+/g, '_').replace(/^_+|_+$/g, '') || 'system';
  const kind = kindOf(state.text);
  return `${stem}${kind !== 'run' || isConfiguration(state.text) ? `_${kind}` : ''}.toml`;
}

const word = (text) => (/^[\w.,:=/+-]+$/.test(text) ? text : `'${text}'`);

/** The command that does the same. */
export function commandOf(state, registered) {
  const file = fileOf(state);
  const kind = kindOf(state.text);
  if (kind !== 'run') return `hamel ${kind} ${file}`;
  const words = ['hamel', 'run'];
  if (state.system && state.text === registered) words.push(state.system);
  else if (isConfiguration(state.text)) words.push('--config', file);
  else words.push(file);
  for (const [name, value] of Object.entries(state.parameters)) words.push('--set', word(`${name}=${value.join(',')}`));
  for (const [name, value] of Object.entries(state.inputs)) words.push('--input', word(`${name}=${value}`));
  for (const [name, value] of Object.entries(state.options)) words.push(`--${name.replaceAll('_', '-')}`, ...(value === 'true' ? [] : [word(value)]));  // that of a flag alone
  return words.join(' ');
}

const literal = (text) => (/^[-+]?[\d.]+(e[-+]?\d+)?$/i.test(text) ? text : /^(true|false)$/.test(text) ? text[0].toUpperCase() + text.slice(1) : JSON.stringify(text));
const quoted = (text) => (text.includes("'''") ? JSON.stringify(text) : `r'''\n${text.replace(/\n*$/, '\n')}'''`);
const dict = (entries) => `{${Object.entries(entries).map(([name, value]) => `${JSON.stringify(name)}: ${Array.isArray(value) ? `[${value.join(', ')}]` : value}`).join(', ')}}`;

/** The same in Python. */
export function pythonOf(state, registered) {
  const system = state.system && state.text === registered ? JSON.stringify(state.system) :
    isConfiguration(state.text) ? `hamel.Config.from_toml(${quoted(state.text)})` : quoted(state.text);
  const kind = kindOf(state.text), file = fileOf(state);
  if (kind !== 'run') return `import hamel\n\nopen("${file}", "w").write(${quoted(state.text)})\nresult = hamel.${kind}("${file}")\nprint(result)\n`;
  const words = [system, ...Object.entries(state.options).map(([name, value]) => `${name === 'from' ? 'from_' : name}=${literal(value)}`),
    ...['parameters', 'inputs'].filter((part) => Object.keys(state[part]).length).map((part) => `${part}=${dict(state[part])}`)];
  return `import hamel\n\nresult = hamel.run(${words.join(', ')})\nprint(result)\nresult.write_page("${file.replace(/\.toml$/, '.html')}")\n`;
}
