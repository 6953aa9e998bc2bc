// Settings on trial, dwelling, and scanning with one and two switches.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { button, whenPage } from './browser.mjs';
import { byOneKey, Person, tabTo } from './person.mjs';
import { endSession, useSystem } from './setup.mjs';
import { until } from './system.mjs';

const it = useSystem();
const WANT = { action: 'Open', category: 'Carton' };

const settings = async () => (await it.system.get('api/settings')).settings;

/** Keeps settings without the page. */
async function keep(change) {
  const { settings: now, presets } = await it.system.get('api/settings');
  const preset = change.access ? presets[change.access] : now;
  const tried = await it.system.send('PUT', 'api/settings', {
    settings: { ...preset, ...change, scan: { ...preset.scan, ...change.scan } } });
  assert.equal(tried.status, 200, JSON.stringify(tried.body));
  assert.equal((await it.system.send('POST', 'api/settings/keep', {})).status, 200);
}

async function openSettings() {
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button, [data-control=start]').first().waitFor();
  await button(page, 'Settings').click();
  await button(page, 'Try these settings').waitFor();
  return page;
}

test('settings that are tried count at once, and stay when they are kept', async () => {
  const page = await openSettings();
  await page.getByLabel('Dark', { exact: true }).check();
  await button(page, 'Try these settings').click();
  await page.getByText('Keep these settings?').first().waitFor();
  await page.locator('html[data-theme=dark]').waitFor();
  await button(page, 'Keep').click();
  await page.getByText('The new settings are kept.').waitFor();
  assert.equal((await settings()).theme, 'dark');
  await page.reload();
  await page.locator('html[data-theme=dark]').waitFor();
  await keep({ theme: 'auto' });
  await page.locator('html[data-theme=light]').waitFor();
  await page.context().close();
});

test('settings that nobody keeps fall back by themselves, and the page says so', async () => {
  const page = await openSettings();
  await page.getByLabel('High contrast', { exact: true }).check();
  await button(page, 'Try these settings').click();
  await page.locator('html[data-theme=contrast]').waitFor();
  const [first] = (await page.locator('#trial p').first().textContent()).match(/\d+/);
  assert.ok(Number(first) <= 20 && Number(first) > 15, first);
  await whenPage(page, (n) => Number(document.querySelector('#trial p').textContent.match(/\d+/)[0]) < n, Number(first), 5000);
  await page.getByText('The earlier settings are back.').waitFor({ timeout: 25000 });
  await page.locator('html[data-theme=light]').waitFor();
  assert.equal((await settings()).theme, 'auto');
  await page.context().close();
});

test('a wrong setting changes nothing, and the page says which it is', async () => {
  const page = await openSettings();
  const before = await settings();
  await page.getByLabel('Time for each', { exact: true }).fill('999');
  await button(page, 'Try these settings').click();
  await page.locator('#settings-error:not(:empty)').waitFor();
  assert.match(await page.locator('#settings-error').textContent(), /scan_time_s.*999/);
  assert.deepEqual(await settings(), before);
  await page.context().close();
});

test('settings are changed by the keyboard alone', async () => {
  const page = await openSettings();
  await tabTo(page, page.locator('input[name=theme]:checked'), 120);
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowRight');
  await tabTo(page, button(page, 'Try these settings'), 120);
  await page.keyboard.press('Enter');
  await page.locator('html[data-theme=dark]').waitFor();
  await page.keyboard.press('Home');
  const keepButton = button(page, 'Keep');
  for (let i = 0; i < 120 && !(await keepButton.evaluate((e) => e === document.activeElement)); ++i) {
    await page.keyboard.press('Shift+Tab');
  }
  await page.keyboard.press('Enter');
  await page.getByText('The new settings are kept.').waitFor();
  await keep({ theme: 'auto' });
  await page.context().close();
});

test('a pointer that rests on a button clicks it once', async () => {
  await keep({ access: 'gaze', dwell_s: 0.4 });
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  const person = new Person(it.system, page, WANT);
  const state = await person.converse(async (index) => {
    await page.mouse.move(5, 5);
    const box = await page.locator('#options button').nth(index).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2, { steps: 3 });
    await page.locator('.dwelling').first().waitFor({ timeout: 2000 });
    const text = await page.locator('#question').textContent();
    await whenPage(page, (t) => document.getElementById('question').textContent !== t ||
      document.querySelector('#options .chosen'), text);
  });
  assert.deepEqual([state.event.kind, state.task.category], ['confirmed', 'Carton']);
  assert.equal(state.task.questions, person.questions, 'every rest was one answer');
  await page.mouse.move(5, 5);
  const stop = await button(page, 'Stop').boundingBox();
  await page.mouse.move(stop.x + 20, stop.y + 20, { steps: 3 });
  await until(async () => (await it.system.state()).stopped, 'a stop by dwelling');
  await it.system.send('POST', 'api/request', { request: 'resume', confirm: true });
  await keep({ access: 'pointer', dwell_s: 0 });
  await page.context().close();
});

test('a whole session by one key ends in the right task; the key clicks nothing by itself', async () => {
  await keep({ access: 'one_switch', scan: { scan_time_s: 0.9, first_item_delay_s: 0.3, ignore_repeat_s: 0.1, rounds: 0 } });
  const page = await it.browser.open(it.system.url);
  await page.locator('#options .lit').first().waitFor();
  const person = new Person(it.system, page, WANT);
  const state = await person.converse(byOneKey(page));
  assert.deepEqual([state.event.kind, state.task.action, state.task.category], ['confirmed', 'Open', 'Carton']);
  assert.ok(person.questions > 0);
  await until(async () => {
    await page.waitForTimeout(200);  // a press sooner after the last one is a repeat
    if (await page.locator('[data-control=start].lit').count()) await page.keyboard.press(' ', { delay: 20 });
    return (await it.system.state()).phase === 'running';
  }, 'a new session by the key');
  await endSession(it.system);
  await page.context().close();
});

test('holding the key stops, whatever has the focus; two choices by the key lead out of it', async () => {
  const page = await it.browser.open(it.system.url);
  await page.locator('.lit').first().waitFor();
  await page.locator('#nav button').nth(1).focus();
  await page.keyboard.down(' ');
  await until(async () => (await it.system.state()).stopped, 'a stop by holding');
  await page.keyboard.up(' ');
  assert.equal(await page.locator('#nav button').nth(1).getAttribute('aria-pressed'), 'false', 'the key clicks nothing');
  for (let i = 0; i < 8 && (await it.system.state()).stopped; ++i) {
    await page.locator('[data-control=resume].lit').waitFor();
    await page.keyboard.down(' ');
    await page.keyboard.up(' ');
    await page.waitForTimeout(300);  // a second press too soon is a repeat
  }
  assert.equal((await it.system.state()).stopped, false);
  await page.locator('#view-stopped').waitFor({ state: 'hidden' });
  await page.context().close();
});

test('the pad is the switch for a finger, and the page stays usable by mouse for a carer', async () => {
  const page = await it.browser.open(it.system.url, { size: [375, 667], hasTouch: true });
  await page.locator('#options .lit, [data-control=start].lit').first().waitFor();
  const presses = [];
  page.on('request', (request) => request.url().endsWith('/api/press') && presses.push(request.postDataJSON()));
  await page.locator('#pad').tap();
  await until(() => presses.length === 2, 'press and release');
  assert.deepEqual(presses, [{ switch: 0, down: true }, { switch: 0, down: false }]);
  await button(page, 'History').click();
  await page.locator('#view-history:not([hidden])').waitFor();
  await page.context().close();
});

test('a key that repeats, or is held while the window loses the focus, is one press', async () => {
  const page = await it.browser.open(it.system.url);
  await page.locator('.lit').first().waitFor();
  const presses = [];
  page.on('request', (request) => request.url().endsWith('/api/press') && presses.push(request.postDataJSON()));
  await page.evaluate(() => {
    const send = (type, repeat) => document.body.dispatchEvent(new KeyboardEvent(type, {
      key: ' ', code: 'Space', bubbles: true, cancelable: true, repeat }));
    send('keydown', false);
    for (let i = 0; i < 20; ++i) send('keydown', true);
    window.dispatchEvent(new Event('blur'));
    send('keyup', false);
  });
  await until(() => presses.length >= 2, 'press and release');
  assert.deepEqual(presses, [{ switch: 0, down: true }, { switch: 0, down: false }]);
  await page.context().close();
});

test('two switches: one steps, the other chooses', async () => {
  await keep({ access: 'two_switches', scan: { method: 'step', ignore_repeat_s: 0.05, rounds: 0 } });
  await endSession(it.system);
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  const person = new Person(it.system, page, WANT);
  const state = await person.converse(async (index) => {
    const isLit = () => page.locator('#options > *').nth(index).evaluate((e) => e.classList.contains('lit'));
    for (let i = 0; i < 30 && !(await isLit()); ++i) {
      await page.keyboard.press(' ', { delay: 20 });
      await page.waitForTimeout(200);  // what was stepped to has to be shown; presses sooner are repeats
    }
    await page.keyboard.press('Enter', { delay: 20 });
  });
  assert.deepEqual([state.event.kind, state.task.category], ['confirmed', 'Carton']);
  await keep({ access: 'pointer' });
  await page.context().close();
});

test('nothing was loaded from elsewhere, and no error was logged', () => {
  assert.deepEqual(it.browser.problems.filter((each) => !/status of 400/.test(each)), []);
});
