// Stop from the page: at any moment, in one press or one key; two deliberate steps lead out of it.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { button, heading, whenPage } from './browser.mjs';
import { endSession, useSystem } from './setup.mjs';
import { until } from './system.mjs';

const it = useSystem();

const isStopped = async (expected = true) =>
  until(async () => (await it.system.state()).stopped === expected, `stopped: ${expected}`);

/** Two steps; leaves the page as it was before the stop. */
async function resume(page) {
  await heading(page).filter({ hasText: 'Stopped' }).waitFor();
  await button(page, 'Resume').click();
  assert.equal((await it.system.state()).stopped, true, 'one step is not enough');
  await button(page, 'Yes, resume').click();
  await isStopped(false);
  await page.locator('#view-stopped').waitFor({ state: 'hidden' });
}

test('Escape stops in every view, wherever the focus is, and so does the button', async () => {
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  for (const view of ['Question', 'History', 'Who am I?', 'Settings']) {
    await button(page, view).click();
    const inside = page.locator('main section:visible').locator('button, input, summary').first();
    if (await inside.count()) await inside.focus();
    await page.keyboard.press('Escape');
    await isStopped();
    await resume(page);
    await button(page, view).click();
    await button(page, 'Stop').click();
    await isStopped();
    await resume(page);
  }
  await page.context().close();
});

test('the Stop button stays in its place and nothing covers it', async () => {
  for (const size of [[1280, 800], [768, 1024], [375, 667], [320, 480]]) {
    const page = await it.browser.open(it.system.url, { size });
    await page.locator('#options button, [data-control=start]').first().waitFor();
    const places = new Set();
    for (const view of ['Question', 'History', 'Who am I?', 'Settings']) {
      await button(page, view).click();
      await page.locator('#scroll').evaluate((element) => element.scrollTo(0, element.scrollHeight));
      places.add(JSON.stringify(await button(page, 'Stop').boundingBox()));
      const onTop = await page.evaluate(() => {
        const box = document.getElementById('stop').getBoundingClientRect();
        return document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2).closest('#stop') !== null;
      });
      assert.ok(onTop, `${view} at ${size}`);
    }
    assert.equal(places.size, 1, [...places].join(' '));
    await page.context().close();
  }
});

test('a stop comes through while an answer is on its way', async () => {
  const page = await it.browser.open(it.system.url);
  await button(page, 'New task').or(page.locator('#options button').first()).first().waitFor();
  if ((await it.system.state()).phase === 'idle') await button(page, 'New task').click({ timeout: 2000 }).catch(() => {});
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  await page.evaluate(() => {
    document.querySelector('#options button').click();
    document.getElementById('stop').click();
  });
  await isStopped();
  await resume(page);
  await page.context().close();
});

test('"Stay stopped" and Escape leave everything stopped', async () => {
  const page = await it.browser.open(it.system.url);
  await page.waitForLoadState('domcontentloaded');
  await page.keyboard.press('Escape');
  await isStopped();
  await button(page, 'Resume').click();
  assert.equal(await page.evaluate(() => document.activeElement.id), 'resume-question');
  await button(page, 'Stay stopped').click();
  assert.equal(await button(page, 'Yes, resume').count(), 0);
  await page.keyboard.press('Escape');
  assert.equal((await it.system.state()).stopped, true);
  await resume(page);
  await page.context().close();
});

test('a page opened while everything is stopped says so and starts nothing', async () => {
  await it.system.send('POST', 'api/request', { request: 'stop' });
  await isStopped();
  const page = await it.browser.open(it.system.url);
  await heading(page).filter({ hasText: 'Stopped' }).waitFor();
  assert.equal((await it.system.state()).query, null);
  await resume(page);
  await page.context().close();
});

test('the partner’s view can stop but not resume, answer or start', async () => {
  await endSession(it.system);
  await until(async () => (await it.system.state()).phase === 'idle', 'no session');
  const partner = await it.browser.open(`${it.system.url}?view=partner`);
  await partner.getByText('answers nothing').waitFor();
  assert.equal((await it.system.state()).phase, 'idle', 'it starts nothing');
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  await whenPage(partner, (text) => document.getElementById('question').textContent === text,
    await page.locator('#question').textContent());
  await partner.locator('#options .option').first().waitFor();
  assert.deepEqual(await partner.getByRole('button').allTextContents().then((all) => all.map((t) => t.trim().split(/\s+/).pop())),
    ['Stop'], 'its only button');
  assert.equal(await partner.locator('input, select, textarea, a:not(.skip)').count(), 0);
  await partner.keyboard.press('Enter');
  await partner.keyboard.press(' ');
  await partner.locator('#options .option').first().click();
  assert.equal((await it.system.state()).query.questions_asked, 0);
  await button(partner, 'Stop').click();
  await isStopped();
  await heading(partner).filter({ hasText: 'Stopped' }).waitFor();
  assert.equal(await button(partner, 'Resume').count(), 0);
  await resume(page);
  await page.context().close();
  await partner.context().close();
});

test('a stop that cannot be sent is said loudly, and sent when that is possible again', async () => {
  const page = await it.browser.open(it.system.url, { quiet: true });
  await page.locator('#offline:empty').waitFor({ state: 'attached' });
  await page.route('**/api/request', (route) => route.abort());
  await button(page, 'Stop').click();
  await page.getByText('STOP DID NOT GET THROUGH').waitFor();
  await page.unroute('**/api/request');
  await isStopped();
  await resume(page);
  await page.context().close();
});

test('nothing was loaded from elsewhere, and no error was logged', () => {
  assert.deepEqual(it.browser.problems, []);
});
