// What of the page is checked for accessibility: its views, themes and sizes, by axe-core and by
// measuring. The tests want no violation; report.mjs writes the result down.

import { createRequire } from 'node:module';
import { button, heading, whenPage } from './browser.mjs';
import { endSession } from './setup.mjs';
import { until } from './system.mjs';

const require = createRequire(import.meta.url);
export const axeVersion = require('axe-core/package.json').version;
const AXE = require.resolve('axe-core/axe.min.js');

export const TAGS = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'];
export const THEMES = ['light', 'dark', 'contrast'];
export const SIZES = { desktop: [1280, 800], phone: [375, 667], narrow: [320, 640] };

const question = (page) => page.locator('#options button, #options .option').first().waitFor();
const view = (name) => async (page) => {
  await question(page);
  await button(page, name).click();
  await heading(page).waitFor();
};

/** name -> {query: of the address, show(page, system)}; `leave` undoes what others would see. */
export const VIEWS = {
  question: { show: question },
  why: { show: async (page) => {
    await question(page);
    await button(page, 'Why this question?').click();
  } },
  history: { show: async (page) => {
    await view('History')(page);
    const table = page.getByText('The same as a table');
    if (await table.count()) await table.click();
  } },
  user: { show: view('Who am I?') },
  settings: { show: view('Settings') },
  trial: { show: async (page) => {
    await view('Settings')(page);
    await button(page, 'Try these settings').click();
    await button(page, 'Keep').waitFor();
  }, leave: (system) => system.send('POST', 'api/settings/keep', {}) },
  stopped: { show: async (page) => {
    await page.waitForLoadState('domcontentloaded');
    await button(page, 'Stop').click();
    await button(page, 'Resume').waitFor();
  }, leave: leaveStop },
  resume: { show: async (page) => {
    await page.waitForLoadState('domcontentloaded');
    await button(page, 'Stop').click();
    await button(page, 'Resume').click();
    await button(page, 'Yes, resume').waitFor();
  }, leave: leaveStop },
  over: { show: async (page, system) => {
    await question(page);
    await endSession(system);
    await button(page, 'New task').waitFor();
  } },
  scanning: { show: async (page, system) => {
    await setAccess(system, 'one_switch');
    await page.locator('.lit').first().waitFor();
  }, leave: (system) => setAccess(system, 'pointer') },
  partner: { query: 'view=partner&', beside: true, show: question },
};

async function leaveStop(system) {
  await system.send('POST', 'api/request', { request: 'resume', confirm: true });
  await until(async () => !(await system.state()).stopped, 'the stop to be over');
}

export async function setAccess(system, access) {
  const { presets } = await system.get('api/settings');
  await system.send('PUT', 'api/settings', { settings: presets[access] });
  await system.send('POST', 'api/settings/keep', {});
}

/** Opens a view, calls `look(page)`, and leaves it. */
export async function inView({ system, browser }, name, { theme = 'light', size = [1280, 800], text = 100, ...options }, look) {
  const { query = '', beside, show, leave } = VIEWS[name];
  const other = beside ? await browser.open(system.url) : null;
  const page = await browser.open(`${system.url}?${query}theme=${theme}&text=${text}`, { size, ...options });
  try {
    await whenPage(page, () => document.getElementById('offline').textContent === '' && document.documentElement.dataset.motion);
    await show(page, system);
    return await look(page);
  } finally {
    await leave?.(system);
    await page.context().close();
    await other?.context().close();
  }
}

/** Violations, and how many rules passed. */
export async function axe(page) {
  // The page's own policy lets no foreign script in; the debugger may.
  await page.evaluate(require('node:fs').readFileSync(AXE, 'utf8'));
  return page.evaluate(async (tags) => {
    const { violations, passes, incomplete } = await window.axe.run(document, { runOnly: tags });
    const brief = (each) => ({ id: each.id, help: each.help, nodes: each.nodes.map((node) => node.html.slice(0, 160)) });
    return { violations: violations.map(brief), passes: passes.length, incomplete: incomplete.map(brief) };
  }, TAGS);
}

/** Whatever can be pressed and is smaller than 44 px: name and size. */
export const smallTargets = (page) => page.evaluate(() => {
  const shown = (e) => e.checkVisibility() && !e.matches('.skip') && !e.closest('label.radio, label.check, [hidden]');
  return [...document.querySelectorAll('button, summary, a[href], input, label.radio, label.check, select')]
    .filter((e) => shown(e) || e.matches('label.radio, label.check') && e.checkVisibility())
    .map((e) => [e.textContent.trim() || e.getAttribute('aria-label') || e.id, e.getBoundingClientRect()])
    .filter(([, box]) => box.width < 44 || box.height < 44)
    .map(([name, box]) => `${name}: ${Math.round(box.width)} x ${Math.round(box.height)}`);
});

/** The least width or height of what can be pressed, px. */
export const leastTarget = (page) => page.evaluate(() => Math.min(
  ...[...document.querySelectorAll('button, summary, label.radio, label.check')].filter((e) => e.checkVisibility())
    .map((e) => e.getBoundingClientRect()).map((box) => Math.min(box.width, box.height))));

/** What is wider than the window, so that one would have to scroll in two directions. */
export const tooWide = (page) => page.evaluate(() => {
  const scroll = document.getElementById('scroll');
  const isInside = (e) => e.closest('.scrolls, svg, .skip');
  const wide = [...document.querySelectorAll('body *')].filter((e) => e.checkVisibility() && !isInside(e) &&
    e.getBoundingClientRect().right > innerWidth + 1).map((e) => e.outerHTML.slice(0, 100));
  return scroll.scrollWidth > scroll.clientWidth + 1 || document.documentElement.scrollWidth > innerWidth ? ['scrolls', ...wide] : wide;
});
