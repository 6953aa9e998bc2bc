// Writes docs/front-ends/accessibility.md: what axe-core and measuring say of every view.

import fs from 'node:fs';
import path from 'node:path';
import { axe, axeVersion, inView, leastTarget, SIZES, smallTargets, TAGS, THEMES, tooWide, VIEWS } from './accessibility.mjs';
import { Browser } from './browser.mjs';
import { SOURCE, System } from './system.mjs';

const FILE = process.argv[2] ?? path.join(SOURCE, 'docs/front-ends/accessibility.md');

async function look(it, name) {
  const row = { name, violations: [], incomplete: new Set(), passes: 0, small: new Set(), wide: new Set(), least: Infinity };
  await inView(it, name, {}, async (page) => {
    for (const theme of THEMES) {
      await page.evaluate((value) => (document.documentElement.dataset.theme = value), theme);
      const found = await axe(page);
      row.passes += found.passes;
      row.violations.push(...found.violations.map((each) => `${each.id} (${theme}): ${each.help}`));
      found.incomplete.forEach((each) => row.incomplete.add(each.id));
    }
    for (const [width, height] of Object.values(SIZES)) {
      await page.setViewportSize({ width, height });
      for (const text of ['100%', '200%']) {
        await page.evaluate((value) => (document.documentElement.style.fontSize = value), text);
        (await smallTargets(page)).forEach((each) => row.small.add(each));
        (await tooWide(page)).forEach((each) => row.wide.add(each));
        row.least = Math.min(row.least, await leastTarget(page));
      }
    }
  });
  return row;
}

const list = (items) => ([...items].length === 0 ? 'none' : [...items].join(', '));

function render(rows, version) {
  const line = (r) => `| ${r.name} | ${r.violations.length} | ${r.passes} | ${list(r.incomplete)} | ${Math.floor(r.least)} px | ` +
    `${r.small.size} | ${r.wide.size} |`;
  const wrong = rows.flatMap((r) => [...r.violations, ...r.small, ...r.wide].map((each) => `- ${r.name}: ${each}`));
  return `# Accessibility of the page: what was measured

Made by \`tests/browser/run --report\`; \`tests/browser/accessibility.test.mjs\` wants zeros. [web.md](web.md) says what
this does not tell.

axe-core ${axeVersion} (tags ${TAGS.join(', ')}) in Chromium ${version}, themes ${THEMES.join(', ')}, with the real programs
behind the page. Targets and reflow at ${Object.values(SIZES).map(([w, h]) => `${w}x${h}`).join(', ')}, each with 100 % and 200 % text.

| view | violations | rules passed, three themes | for a person to judge | least target | below 44 px | wider than the window |
|---|---|---|---|---|---|---|
${rows.map(line).join('\n')}
${wrong.length > 0 ? `\n${wrong.join('\n')}\n` : ''}`;
}

const it = { system: await System.start(), browser: await Browser.start() };
try {
  const rows = [];
  for (const name of Object.keys(VIEWS)) rows.push(await look(it, name));
  fs.mkdirSync(path.dirname(FILE), { recursive: true });
  fs.writeFileSync(FILE, render(rows, it.browser.chromium.version().split('.')[0]));
  console.log(FILE);
} finally {
  await it.browser.stop();
  await it.system.stop();
}
