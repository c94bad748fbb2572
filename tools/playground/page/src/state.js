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

/** Is it the configuration of a run, not a system? */
export const isConfiguration = (text) => /^\s*system\s*=/m.test(text.split(/^\s*\[/m)[0]);

/** The name of its file. */
export function fileOf(state) {
  const name = /^\s*name\s*=\s*["']([^"']+)["']/m.exec(state.text)?.[1] || state.system || 'system';
  const stem = name.toLowerCase().replace(/[^a-z0-9]+/g, '_').replace(/^_+|_+$/g, '') || 'system';
  return `${stem}${isConfiguration(state.text) ? '_run' : ''}.toml`;
}

const word = (text) => (/^[\w.,:=/+-]+$/.test(text) ? text : `'${text}'`);

/** The command that does the same. */
export function commandOf(state, registered) {
  const file = fileOf(state);
  const words = ['hamel', 'run'];
  if (state.system && state.text === registered) words.push(state.system);
  else if (isConfiguration(state.text)) words.push('--config', file);
  else words.push(file);
  for (const [name, value] of Object.entries(state.parameters)) words.push('--set', word(`${name}=${value.join(',')}`));
  for (const [name, value] of Object.entries(state.inputs)) words.push('--input', word(`${name}=${value}`));
  for (const [name, value] of Object.entries(state.options)) words.push(`--${name.replaceAll('_', '-')}`, word(value));
  return words.join(' ');
}
