// node test/sample.mjs BUILT.html OUTPUT.html: a sample page with all kinds of blocks.

import { readFileSync, writeFileSync } from 'node:fs';
import { fill } from './fill.mjs';
import { sample } from './sample_data.mjs';

const [page, output] = process.argv.slice(2);
if (!output) {
  console.error('usage: node test/sample.mjs BUILT.html OUTPUT.html');
  process.exit(2);
}
writeFileSync(output, fill(readFileSync(page, 'utf8'), JSON.stringify(sample)));
