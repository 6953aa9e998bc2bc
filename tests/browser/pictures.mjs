// Pictures of the page for the documents, from the real programs: docs/pictures/page-*.png.

import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { inView } from './accessibility.mjs';
import { Browser, whenPage } from './browser.mjs';
import { byMouse, Person } from './person.mjs';
import { SOURCE, System } from './system.mjs';

const OUT = process.argv[2] ?? path.join(SOURCE, 'docs/pictures');

// name: view, and how it is looked at.
const PICTURES = {
  light: ['question', {}],
  dark: ['question', { theme: 'dark' }],
  contrast: ['question', { theme: 'contrast' }],
  phone: ['question', { size: [375, 667] }],
  scanning: ['scanning', {}],
  stopped: ['stopped', { size: [900, 500] }],
  partner: ['partner', {}],
  why: ['why', { size: [1280, 1250] }],
  history: ['history', { size: [1000, 850] }],
  settings: ['settings', { size: [1000, 800] }],
};

/** Fewer colours where the tool for it is there: half the bytes. */
function compress(file) {
  try {
    execFileSync('pngquant', ['--force', '--skip-if-larger', '--output', file, '128', file]);
  } catch {
    // As it is.
  }
}

async function liveSome(it) {
  const wants = [['Open', 'Carton'], ['Drink', 'Cup'], ['Open', 'Carton'], ['Open', 'Carton'], ['Drink', 'Cup'], ['Open', 'Carton']];
  const page = await it.browser.open(it.system.url);
  for (const [action, category] of wants) {
    const person = new Person(it.system, page, { action, category });
    await person.begin((target) => target.click({ timeout: 1000 }));
    await person.converse(byMouse(page));
  }
  await page.context().close();
}

const it = { system: await System.start(), browser: await Browser.start() };
try {
  await liveSome(it);
  for (const [name, [view, options]] of Object.entries(PICTURES)) {
    const file = path.join(OUT, `page-${name}.png`);
    await inView(it, view, options, async (page) => {
      if (await page.locator('#picture:visible').count()) {
        await whenPage(page, () => document.querySelector('#picture img').naturalWidth > 0 &&
          document.querySelectorAll('#picture path.shape').length > 0);
      }
      await page.screenshot({ path: file });
    });
    compress(file);
    console.log(`${file}: ${Math.round(fs.statSync(file).size / 1000)} kB`);
  }
} finally {
  await it.browser.stop();
  await it.system.stop();
}
