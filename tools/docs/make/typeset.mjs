// node typeset.mjs PACKAGES < [formula, …] > [HTML, …]: LaTeX set by the KaTeX of PACKAGES/node_modules. Exit status 1: a formula that it cannot read.
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const packages = resolve(process.argv[2]);
const { default: katex } = await import(pathToFileURL(join(packages, 'node_modules/katex/dist/katex.mjs')));
const formulas = JSON.parse(readFileSync(0, 'utf8'));
process.stdout.write(JSON.stringify(formulas.map((formula) => {
  try {
    return katex.renderToString(formula, { throwOnError: true, strict: (code) => (code === 'unknownSymbol' ? 'error' : 'ignore'), trust: true });
  } catch (error) {
    console.error(`${formula}: ${error.message}`);
    process.exit(1);
  }
})));
