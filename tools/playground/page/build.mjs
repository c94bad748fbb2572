// node build.mjs MODULE OUTPUT: the page as files (OUTPUT/index.html) and as one file that runs from disk (OUTPUT/playground.html).
// MODULE has hamel.js and hamel.wasm. Packages are those of this folder, and of ../../report beside it.

import { createRequire } from 'node:module';
import { cpSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';

const here = dirname(fileURLToPath(import.meta.url));
const report = join(here, '../../report');
const { build } = createRequire(join(report, 'package.json'))('esbuild');
const [module, output] = process.argv.slice(2).map((path) => resolve(path));
if (!output) {
  console.error('usage: node build.mjs MODULE OUTPUT');
  process.exit(2);
}

const OPTIONS = { bundle: true, minify: true, charset: 'utf8', legalComments: 'none', logLevel: 'warning', outdir: output, write: false,
  target: ['chrome103', 'firefox113', 'safari16.4'] };
const read = (...path) => readFileSync(join(...path), 'utf8');
const bundled = async (entry, more) => {
  const { outputFiles, metafile } = await build({ ...OPTIONS, metafile: true, entryPoints: [join(here, 'src', entry)], ...more });
  return Object.assign(outputFiles, { metafile });
};

const licence = (folder, name) => `${name}\n${read(folder, 'node_modules', name, 'LICENSE').trim()}`;
const licences = [...['echarts', 'zrender', 'three'].map((name) => licence(report, name)), licence(here, '@codemirror/view')].join('\n\n');
const POLICY = {
  files: "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; style-src 'self' 'unsafe-inline'; img-src data: blob:",
  one: "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; style-src 'unsafe-inline'; img-src data: blob:",
};
const fill = (text, marks) => Object.entries(marks).reduce((done, [mark, value]) => {
  if (done.split(mark).length !== 2) throw new Error(`index.html needs ${mark} exactly once`);
  return done.replace(mark, () => value);
}, text);
const comment = `<!--\nThis page contains:\n\n${licences.replace(/--/g, '- -')}\n-->`;
const template = read(here, 'src/index.html');
const textOf = (files, extension) => files.find(({ path }) => path.endsWith(extension)).text.trim();

rmSync(output, { recursive: true, force: true });
mkdirSync(output, { recursive: true });

// hamel.js and the worker are one file.
const worker = `${read(module, 'hamel.js')}\n${textOf(await bundled('worker.js', { format: 'esm' }), '.js')}`;

// As files: the charts and the editor are parts of their own, which come behind the first motion.
const parts = await bundled('main.js', { format: 'esm', splitting: true, entryNames: 'playground', chunkNames: 'part-[hash]' });
parts.filter(({ path }) => path.endsWith('.js') || path.endsWith('playground.css')).forEach(({ path, contents }) => writeFileSync(path, contents));
writeFileSync(join(output, 'worker.js'), worker);
cpSync(join(module, 'hamel.wasm'), join(output, 'hamel.wasm'));
// The motions of the registered systems: a page shows the one of its address while the library is on its way.
async function storedMotions() {
  const library = await createRequire(import.meta.url)(join(module, 'hamel.js'))({ wasmBinary: readFileSync(join(module, 'hamel.wasm')) });
  const call = (name, ...request) => JSON.parse(library.ccall(`hamel_${name}`, 'string', request.map(() => 'string'), request.map((given) => JSON.stringify(given))));
  return Object.fromEntries(call('catalogue').systems.map(({ name }) => {
    const { text } = call('text', { name });
    const { ok, motion } = call('run', { text, origin: name, options: {}, parameters: {}, inputs: {} });
    if (!ok || !motion) return [name, null];
    const at = library.ccall('hamel_motion', 'number', [], []) / 8;
    const numbers = Float32Array.from(library.HEAPF64.subarray(at, at + library.ccall('hamel_motion_size', 'number', [], [])));
    return [name, { text, motion, numbers: Buffer.from(numbers.buffer).toString('base64') }];
  }).filter(([, stored]) => stored));
}
const stored = await storedMotions();
mkdirSync(join(output, 'motions'));
Object.entries(stored).forEach(([name, motion]) => writeFileSync(join(output, `motions/${name}.json`), JSON.stringify(motion)));

// The worker and the module begin before the page's own code is there.
const COMPILED = `(async (answer) => {
  const again = (await answer).clone();  // for a server that gives the file another type
  return WebAssembly.compileStreaming(answer).catch(async () => WebAssembly.compile(await again.arrayBuffer()));
})`;
const source = (make, wasm, motion, first = '') => `(() => {
${first}  const make = () => ${make};
  let first = make();
  const worker = () => {
    const one = first ?? make();
    first = null;
    return one;
  };
  globalThis.hamelSource = { worker, compiled: ${COMPILED}(${wasm}), stored: async (name) => ${motion} };
})();
`;
// A browser gives a page from disk no files: there the one file takes over.
writeFileSync(join(output, 'source.js'), source("new Worker('worker.js')", "fetch('hamel.wasm')",
  "fetch(`motions/${encodeURIComponent(name)}.json`).then((answer) => (answer.ok ? answer.json() : null))",
  "  if (location.protocol === 'file:') return location.replace(`playground.html${location.hash}`);\n"));
const first = parts.metafile.outputs[Object.keys(parts.metafile.outputs).find((path) => path.endsWith('playground.js'))];
const preloads = first.imports.filter(({ kind }) => kind === 'import-statement').map(({ path }) => `<link rel="modulepreload" href="${basename(path)}">`);
writeFileSync(join(output, 'index.html'), fill(template, {
  POLICY: POLICY.files,
  '<!--HEAD-->': `${comment}\n<script src="source.js"></script>\n${preloads.join('\n')}\n<link rel="stylesheet" href="playground.css">`,
  '<!--SCRIPTS-->': '<script type="module" src="playground.js"></script>',
}));

// As one file: everything inside, the module compressed.
const quoted = (text) => JSON.stringify(text).replaceAll('<', '\\u003c');
const whole = await bundled('main.js', { format: 'iife' });
const inScript = (text) => text.replace(/<\/(script)/gi, '<\\/$1').replace(/<!--/g, '<\\!--');
const within = source(`new Worker(URL.createObjectURL(new Blob([${quoted(worker)}], { type: 'text/javascript' })))`,
  `new Promise((done) => { addEventListener('DOMContentLoaded', done); }).then(() => new Response(new Blob([Uint8Array.from(atob(document.getElementById('module').textContent), (c) => c.charCodeAt(0))])
    .stream().pipeThrough(new DecompressionStream('gzip')), { headers: { 'content-type': 'application/wasm' } }))`,
  "(({ [name]: motion }) => motion ?? null)(JSON.parse(document.getElementById('stored').textContent))");
const FIRST = /const FIRST = '(\w+)'/.exec(read(here, 'src/main.js'))[1];
writeFileSync(join(output, 'playground.html'), fill(template, {
  POLICY: POLICY.one,
  '<!--HEAD-->': `${comment}\n<style>${textOf(whole, '.css')}</style>`,
  // The module is the last: the first motion does not wait until it is read.
  '<!--SCRIPTS-->': `<script type="application/json" id="stored">${quoted({ [FIRST]: stored[FIRST] })}</script>\n<script>${within}</script>\n` +
    `<script>${inScript(textOf(whole, '.js'))}</script>\n` +
    `<script type="text/plain" id="module">${gzipSync(readFileSync(join(module, 'hamel.wasm')), { level: 9 }).toString('base64')}</script>`,
}));
console.log(`${join(output, 'index.html')}, and playground.html: ${Math.round(statSync(join(output, 'playground.html')).size / 1024)} KB`);
