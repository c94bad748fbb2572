// The module of the playground in node: its functions by their names.

import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

/** build: the build folder -> {call(name, request), numbers(name, count)}. */
export async function openModule(build) {
  const folder = process.env.HAMEL_MODULE ?? join(build, 'playground/wasm/tools/playground');
  const create = createRequire(import.meta.url)(join(folder, 'hamel.js'));
  const library = await create({ wasmBinary: readFileSync(join(folder, 'hamel.wasm')) });
  const call = (name, request) => JSON.parse(library.ccall(`hamel_${name}`, 'string', request === undefined ? [] : ['string'],
    request === undefined ? [] : [JSON.stringify(request)]));
  const numbers = (name, count) => {
    const at = library.ccall(`hamel_${name}`, 'number', [], []) / 8;
    return library.HEAPF64.slice(at, at + count);
  };
  return { call, numbers };
}
