// Headless Chromium, kept quiet on a closed network; exit 77 (skipped) where it is missing.

import { existsSync } from 'node:fs';

const FLAGS = ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync'];
const SOFTWARE_WEBGL = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

export const PATIENCE = 120000;  // milliseconds: a machine may have other work

function skip(reason) {
  console.log(`skipped: ${reason}`);
  process.exit(77);
}

/** One browser for several processes: its address goes to them in $HAMEL_BROWSER. */
export async function serve() {
  const { playwright, options } = await find();
  return playwright.chromium.launchServer(options);
}

export async function launch() {
  const { playwright, options } = await find();
  const running = process.env.HAMEL_BROWSER;
  return running ? playwright.chromium.connect(running) : playwright.chromium.launch(options);
}

export const executable = () => process.env.CHROMIUM || '/usr/bin/chromium';

async function find() {
  const executablePath = executable();
  if (!existsSync(executablePath)) skip(`no Chromium at ${executablePath}`);
  let playwright;
  try {
    playwright = await import('playwright-core');
  } catch {
    skip('playwright-core is not installed (npm ci)');
  }
  return { playwright, options: { executablePath, args: [...FLAGS, ...SOFTWARE_WEBGL] } };
}
