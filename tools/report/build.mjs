// node build.mjs OUTPUT.html: bundles the page into one file that needs nothing else.

import { build } from 'esbuild';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const output = process.argv[2];
if (!output) {
  console.error('usage: node build.mjs OUTPUT.html');
  process.exit(2);
}

const { outputFiles } = await build({
  entryPoints: [join(here, 'src/page.js')], bundle: true, minify: true, write: false, outdir: 'out',
  format: 'iife', charset: 'utf8', legalComments: 'none', logLevel: 'warning',
  target: ['chrome100', 'firefox100', 'safari15.4'],
});
const bundled = (extension) => outputFiles.find((file) => file.path.endsWith(extension)).text.trim();

// What stands inside <script> and <style> must not end them, nor look like the placeholder.
const script = bundled('.js').replace(/<\/(script)/gi, '<\\/$1').replace(/<!--/g, '<\\!--');
const style = bundled('.css');
const licences = ['echarts', 'zrender', 'three'].map((name) =>
  `${name}\n${readFileSync(join(here, 'node_modules', name, 'LICENSE'), 'utf8').trim()}`).join('\n\n');

const fill = (text, mark, value) => {
  if (text.split(mark).length !== 2) throw new Error(`the template needs ${mark} exactly once`);
  return text.replace(mark, () => value);
};
let page = readFileSync(join(here, 'src/template.html'), 'utf8');
page = fill(page, '<!--LICENCES-->', `<!--\nThis page contains:\n\n${licences.replace(/--/g, '- -')}\n-->`);
page = fill(page, '/*STYLE*/', style);
page = fill(page, '/*SCRIPT*/', script);
if (page.split('__HAMEL_DATA__').length !== 2) throw new Error('the page must hold the placeholder exactly once');
if (/<\/style/i.test(style)) throw new Error('the style sheet ends its own element');

mkdirSync(dirname(resolve(output)), { recursive: true });
writeFileSync(output, page);
console.log(`${output}: ${Math.round(page.length / 1024)} KB`);
