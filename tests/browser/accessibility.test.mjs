// WCAG 2.2 AA, as far as programs can tell: axe-core on every view in every theme, sizes of
// targets, reflow, focus, live regions, forced colours, and the languages' words.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { axe, inView, SIZES, smallTargets, THEMES, tooWide, VIEWS } from './accessibility.mjs';
import { button, whenPage } from './browser.mjs';
import { endSession, useSystem } from './setup.mjs';
import { SOURCE } from './system.mjs';

const it = useSystem();
const PAGE = path.join(SOURCE, 'services/ui_bridge/web/page');
const json = (file) => JSON.parse(fs.readFileSync(path.join(PAGE, file), 'utf8'));

for (const name of Object.keys(VIEWS)) {
  test(`axe finds nothing wrong in the view "${name}", in every theme`, async () => {
    await inView(it, name, {}, async (page) => {
      for (const theme of THEMES) {
        await page.evaluate((value) => (document.documentElement.dataset.theme = value), theme);
        const { violations, passes } = await axe(page);
        assert.ok(passes > 10, `only ${passes} rules applied`);
        assert.deepEqual(violations, [], theme);
      }
    });
  });
}

test('axe sees a fault that is put in', async () => {
  await inView(it, 'question', {}, async (page) => {
    await page.evaluate(() => {
      const button = document.getElementById('main').appendChild(document.createElement('button'));
      button.style.background = button.style.color = '#777';
    });
    assert.deepEqual((await axe(page)).violations.map((each) => each.id), ['button-name']);
  });
});

for (const name of ['question', 'why', 'history', 'user', 'settings', 'resume', 'scanning']) {
  test(`every target is at least 44 px, and nothing scrolls sideways, also with twice the text (${name})`, async () => {
    await inView(it, name, {}, async (page) => {
      for (const [width, height] of Object.values(SIZES)) {
        await page.setViewportSize({ width, height });
        for (const text of ['100%', '200%']) {
          await page.evaluate((value) => (document.documentElement.style.fontSize = value), text);
          assert.deepEqual(await smallTargets(page), [], `${width} px, text ${text}`);
          assert.deepEqual(await tooWide(page), [], `${width} px, text ${text}`);
        }
      }
    });
  });
}

/** Contrast of two colours #rrggbb (WCAG 2.2, "contrast ratio"). */
function contrast(a, b) {
  const luminance = (colour) => {
    const [r, g, blue] = [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16) / 255)
      .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * blue;
  };
  const [light, dark] = [luminance(a), luminance(b)].sort((x, y) => y - x);
  return (light + 0.05) / (dark + 0.05);
}

test('text has a contrast of 4.5, in the theme for it 7, and borders and signs have 3', () => {
  const css = fs.readFileSync(path.join(PAGE, 'theme.css'), 'utf8');
  const themes = [...css.matchAll(/^:root(?:\[data-theme="(\w+)"\])? \{([^}]*)\}/gm)].map(([, name, body]) => [
    name ?? 'light', Object.fromEntries([...body.matchAll(/--([\w-]+): (#\w{6});/g)].map((match) => match.slice(1)))]);
  assert.deepEqual(themes.map(([name]) => name), ['light', 'dark', 'contrast']);
  const texts = [['text', 'back'], ['text', 'card'], ['soft', 'back'], ['soft', 'card'], ['on-accent', 'accent'], ['yes', 'back'],
    ['no', 'back'], ['on-stop', 'stop'], ['warn', 'warn-back'], ['warn', 'card'], ['text', 'lit-back'], ['accent', 'back']];
  const signs = [['line', 'back'], ['line', 'card'], ['focus', 'back'], ['focus', 'card'], ['lit', 'back'], ['accent', 'card'], ['warn', 'back']];
  for (const [name, colours] of themes) {
    const check = (pairs, least) => {
      for (const [a, b] of pairs) {
        const ratio = contrast(colours[a], colours[b]);
        assert.ok(ratio >= least, `${name}: --${a} on --${b} is ${ratio.toFixed(2)}`);
      }
    };
    check(texts, name === 'contrast' ? 7 : 4.5);
    check(signs, 3);
  }
});

test('with the keyboard every control is reached, its focus is seen, and none is a trap', async () => {
  await inView(it, 'settings', {}, async (page) => {
    const expected = await page.evaluate(() => {
      const groups = new Set();
      return [...document.querySelectorAll('a[href], button, input, summary')].filter((e) => {
        if (!e.checkVisibility() && !e.matches('.skip')) return false;
        if (e.type !== 'radio') return true;
        return !groups.has(e.name) && groups.add(e.name);
      }).length;
    });
    await page.locator('#skip').focus();
    await page.keyboard.press('Tab');
    await page.keyboard.press('Shift+Tab');
    const seen = new Set();
    for (let i = 0; i < 200; ++i) {
      const { key, html, shows } = await page.evaluate(() => {
        const e = document.activeElement;
        const shown = e.matches('.radio input, .check input') ? e.parentElement : e;
        const style = getComputedStyle(shown);
        const all = [...document.querySelectorAll('*')];
        return { key: e.type === 'radio' ? e.name : all.indexOf(e), html: e.outerHTML.slice(0, 120), shows: parseFloat(style.outlineWidth) >= 2 && style.outlineStyle !== 'none' };
      });
      if (seen.has(key)) break;
      seen.add(key);
      assert.ok(shows, `the focus is not seen on ${html}`);
      await page.keyboard.press('Tab');
      if (await page.evaluate(() => document.activeElement === document.body)) break;
    }
    assert.equal(seen.size, expected);
  });
});

test('the skip link leads past the navigation', async () => {
  await inView(it, 'question', {}, async (page) => {
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press('Tab');
    assert.equal(await page.evaluate(() => document.activeElement.id), 'skip');
    await page.keyboard.press('Enter');
    await page.keyboard.press('Tab');
    assert.ok(await page.evaluate(() => document.activeElement.closest('#options') !== null));
  });
});

test('a new question is in an assertive live region, and the focus stays on the same answer', async () => {
  await inView(it, 'question', {}, async (page) => {
    const live = page.locator('#asked');
    assert.deepEqual([await live.getAttribute('role'), await live.getAttribute('aria-live')], ['status', 'assertive']);
    const { query } = await it.system.state();
    const isYesNo = query.options[0].text === 'Yes';
    await page.locator('#options button[aria-disabled=false]').first().waitFor();
    await page.locator('#options button').last().focus();
    await page.keyboard.press('Enter');
    await whenPage(page, (text) => document.getElementById('question').textContent !== text, query.text);
    const next = (await it.system.state()).query;
    const focus = await page.evaluate(() => document.activeElement.id || document.activeElement.className);
    assert.equal(focus, isYesNo && next.options[0].text === 'Yes' ? 'no' : 'question');
    assert.equal(await live.locator('h1').textContent(), next.text);
    await endSession(it.system);
  });
});

test('Yes, No, Stop, Undo and None of these have exactly these names', async () => {
  await inView(it, 'question', {}, async (page) => {
    const { query } = await it.system.state();
    for (const { text } of query.options) assert.equal(await button(page, text).count(), 1, text);
    for (const name of ['Stop', 'Undo', 'None of these']) assert.equal(await button(page, name).count(), 1, name);
  });
});

test('with less motion wanted nothing glides', async () => {
  await inView(it, 'question', { reducedMotion: 'reduce' }, async (page) => {
    const timing = await page.evaluate(() => {
      const target = document.getElementById('stop');
      target.classList.add('dwelling');
      return getComputedStyle(target, '::after').animationTimingFunction;
    });
    assert.match(timing, /steps/);
  });
});

test('with forced colours borders and what is lit are still seen', async () => {
  await inView(it, 'scanning', { forcedColors: 'active' }, async (page) => {
    const style = await page.locator('.lit').first().evaluate((e) => {
      const { outlineStyle, outlineWidth, borderStyle } = getComputedStyle(e);
      return [outlineStyle !== 'none', parseFloat(outlineWidth) >= 3, borderStyle !== 'none'];
    });
    assert.deepEqual(style, [true, true, true]);
    assert.deepEqual((await axe(page)).violations, []);
  });
});

test('what is lit is told by a sign and a double line, not by colour alone', async () => {
  await inView(it, 'scanning', {}, async (page) => {
    const [sign, line] = await page.locator('.lit').first().evaluate((e) => [
      getComputedStyle(e, '::before').content, getComputedStyle(e).outlineStyle]);
    assert.match(sign, /▶|❚/);
    assert.match(line, /double|solid/);
  });
});

test('every language has the same words as English, with the same placeholders', () => {
  const english = json('en.json');
  const placeholders = (text) => (text.match(/\{\w+\}/g) ?? []).sort().join();
  const others = fs.readdirSync(PAGE).filter((file) => /^[a-z]{2}\.json$/.test(file) && file !== 'en.json');
  assert.ok(others.length > 0);
  for (const file of others) {
    const words = json(file);
    assert.deepEqual(Object.keys(words).sort(), Object.keys(english).sort(), file);
    for (const [key, text] of Object.entries(words)) {
      assert.equal(placeholders(text), placeholders(english[key]), `${file}: ${key}`);
    }
  }
});

test('the page’s fixed words are those of en.json, and every word it asks for is there', () => {
  const english = json('en.json');
  const html = fs.readFileSync(path.join(PAGE, 'index.html'), 'utf8');
  const fixed = [...html.matchAll(/data-t="([\w.]+)">([^<]*)</g)];
  assert.ok(fixed.length > 5);
  for (const [, key, text] of fixed) assert.equal(text, english[key], key);
  for (const [, text, key] of html.matchAll(/aria-label="([^"]*)" data-t-label="([\w.]+)"/g)) assert.equal(text, english[key], key);
  const isThere = (key) => key in english || `${key}.other` in english;
  for (const file of fs.readdirSync(PAGE).filter((name) => name.endsWith('.js'))) {
    const code = fs.readFileSync(path.join(PAGE, file), 'utf8');
    for (const [, key] of code.matchAll(/\btn?\('([\w.]+)'/g)) assert.ok(isThere(key), `${file}: ${key}`);
  }
});

test('every category and action that ships has a name', () => {
  const english = json('en.json');
  const toml = fs.readFileSync(path.join(SOURCE, 'services/intention/affordances.toml'), 'utf8');
  const section = (name) => toml.split(`[${name}]`)[1].split(/^\[/m)[0];
  const names = (text) => [...text.matchAll(/^(\w+) =/gm)].map((match) => match[1]);
  const [categories, actions] = [names(section('categories')), names(section('actions'))];
  assert.ok(categories.length >= 11 && actions.length >= 7);
  for (const name of categories) assert.ok(`category.${name}` in english, name);
  for (const name of actions) assert.ok(`action.${name}` in english, name);
});

test('nothing was loaded from elsewhere, and no error was logged', () => {
  assert.deepEqual(it.browser.problems, []);
});
