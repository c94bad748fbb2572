// node test/libraries.mjs [FIGURES] [POINTS]: what the charting libraries cost, measured in headless Chromium; prints
// the table of README.md. The libraries stand beside each other in a folder of their own:
//   npm install --no-save echarts plotly.js-cartesian-dist-min vega vega-lite uplot@1.6.32

import { build } from 'esbuild';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';
import { launch } from './browser.mjs';

const [figures = 60, points = 100000] = process.argv.slice(2).map(Number);

/** Each defines draw(holder, x, y): a curve over a linear x axis and a logarithmic y axis, with a title and a legend. */
const LIBRARIES = {
  'uPlot 1.6 (canvas)': `import uPlot from 'uplot';
    window.draw = (holder, x, y) => new uPlot({ title: 'A curve', width: 560, height: 320, scales: { x: { time: false }, y: { distr: 3 } },
      series: [{ label: 't' }, { label: 'error', stroke: '#0072b2' }] }, [x, y], holder);`,
  'Plotly cartesian (SVG)': `import Plotly from 'plotly.js-cartesian-dist-min';
    window.draw = (holder, x, y) => Plotly.newPlot(holder, [{ x, y, mode: 'lines', name: 'error' }], { title: { text: 'A curve' }, width: 560, height: 320,
      yaxis: { type: 'log' }, showlegend: true });`,
  'Vega-Lite (SVG)': `import { compile } from 'vega-lite'; import { parse, View } from 'vega';
    window.draw = (holder, x, y) => new View(parse(compile({ title: 'A curve', width: 500, height: 250, data: { values: Array.from(x, (t, i) => ({ t, e: y[i], name: 'error' })) },
      mark: 'line', encoding: { x: { field: 't', type: 'quantitative' }, y: { field: 'e', type: 'quantitative', scale: { type: 'log' } }, color: { field: 'name' } } }).spec), { renderer: 'svg', container: holder }).runAsync();`,
  ...Object.fromEntries(['SVG', 'Canvas'].map((kind) => [`ECharts (${kind})`, `import { init, use } from 'echarts/core';
    import { HeatmapChart, LineChart } from 'echarts/charts';
    import { AriaComponent, DataZoomComponent, GridComponent, LegendComponent, MarkLineComponent, TooltipComponent, VisualMapComponent } from 'echarts/components';
    import { ${kind}Renderer } from 'echarts/renderers';
    use([HeatmapChart, LineChart, AriaComponent, DataZoomComponent, GridComponent, LegendComponent, MarkLineComponent, TooltipComponent, VisualMapComponent, ${kind}Renderer]);
    window.draw = (holder, x, y) => init(holder, null, { renderer: '${kind.toLowerCase()}', width: 560, height: 320 }).setOption({ animation: false, aria: { enabled: true }, legend: {},
      tooltip: { trigger: 'axis' }, xAxis: { type: 'value' }, yAxis: { type: 'log' }, series: [{ type: 'line', name: 'error', showSymbol: false, sampling: 'minmax', data: x.map((t, i) => [t, y[i]]) }] });`])),
};

const drive = `
  const x = Array.from({ length: ${points} }, (_, i) => i * 0.01);
  const y = (k) => x.map((t) => 10 ** (-12 + k / 10 + 2 * Math.sin(t / (7 + k))) * (1.1 + Math.sin(t * 311)));
  (async () => {
    const curves = Array.from({ length: ${figures} }, (_, k) => y(k));
    const begin = performance.now();
    for (const curve of curves) {
      const holder = document.createElement('div');
      holder.style = 'width:560px;height:320px';
      document.body.append(holder);
      await window.draw(holder, x, curve);
    }
    await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
    window.spent = performance.now() - begin;
  })();`;

const folder = mkdtempSync(join(tmpdir(), 'hamel-libraries-'));
const browser = await launch();
console.log(`| library | code | compressed | ${figures} figures of ${points} points | PDF of that page | texts in it as text |\n|---|---|---|---|---|---|`);
for (const [name, source] of Object.entries(LIBRARIES)) {
  const { outputFiles: [{ contents, text }] } = await build({ stdin: { contents: source, resolveDir: process.cwd() }, bundle: true,
    minify: true, write: false, format: 'iife', logLevel: 'error', loader: { '.css': 'empty' } });
  const file = join(folder, 'page.html');
  writeFileSync(file, `<!doctype html><meta charset=utf-8><body><script>${text.replace(/<\/script/g, '<\\/script')}</script><script>${drive}</script>`);
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  await page.goto(pathToFileURL(file).href, { waitUntil: 'commit' });
  await page.waitForFunction(() => window.spent, null, { timeout: 900000 }).catch(() => {});
  const spent = await page.evaluate(() => window.spent ?? NaN).catch(() => NaN);  // (a page may run out of memory)
  const texts = await page.evaluate(() => document.querySelectorAll('svg text').length).catch(() => 0);
  const pdf = await page.pdf({ timeout: 120000 }).then((bytes) => `${Math.round(bytes.length / 1024)} KB`, () => 'none in 2 min');
  const size = (bytes) => `${Math.round(bytes.length / 1024)} KB`;
  console.log(`| ${name} | ${size(contents)} | ${size(gzipSync(contents))} | ${Number.isFinite(spent) ? `${(spent / 1000).toFixed(1)} s` : 'none in 15 min'} | ${pdf} | ${texts ? 'yes' : 'no'} |`);
  await page.close();
}
await browser.close();
rmSync(folder, { recursive: true, force: true });
