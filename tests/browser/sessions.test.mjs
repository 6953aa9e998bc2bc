// Whole sessions from the first question to the right task, at three sizes of the window.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { button, heading, whenPage } from './browser.mjs';
import { byKeyboard, byMouse, Person, tabTo } from './person.mjs';
import { endSession, useSystem } from './setup.mjs';

const it = useSystem();

function assertTask(state, want) {
  assert.equal(state.event.kind, 'confirmed', JSON.stringify(state.event));
  assert.deepEqual([state.task.action, state.task.category], [want.action, want.category]);
}

const SIZES = { desktop: [1280, 800], tablet: [768, 1024], phone: [375, 667] };

test('the first question stands within a second of opening the page', async () => {
  const page = await it.browser.open(it.system.url);
  const ms = await page.evaluate(() => new Promise((resolve) => {
    const look = () => (document.querySelector('#options button')
      ? resolve(performance.now()) : requestAnimationFrame(look));
    look();
  }));
  assert.ok(ms < 1000, `${Math.round(ms)} ms`);
  console.log(`# first question after ${Math.round(ms)} ms`);
  assert.equal((await it.system.state()).phase, 'running');
  await endSession(it.system);
  await page.context().close();
});

for (const [name, size] of Object.entries(SIZES)) {
  test(`a session by mouse ends in the right task (${name})`, async () => {
    const want = { action: 'Open', category: 'Carton' };
    const page = await it.browser.open(it.system.url, { size });
    const person = new Person(it.system, page, want);
    assertTask(await person.converse(byMouse(page)), want);
    assert.ok(person.questions > 0);
    await heading(page).filter({ hasText: 'Understood' }).waitFor();
    assert.match(await page.locator('#task').textContent(), /Open: carton/);
    await page.context().close();
  });
}

for (const [name, size] of Object.entries(SIZES)) {
  test(`a session by the keyboard alone ends in the right task (${name})`, async () => {
    const want = { action: 'Drink', category: 'Cup' };
    const page = await it.browser.open(it.system.url, { size });
    const person = new Person(it.system, page, want);
    const act = byKeyboard(page);
    assertTask(await person.converse(act), want);
    const again = new Person(it.system, page, want);
    await again.begin(async (target) => {
      await target.waitFor({ timeout: 1000 });
      await tabTo(page, target);
      await page.keyboard.press('Enter');
    });
    again.seen = person.seen;
    assertTask(await again.converse(act), want);
    await page.context().close();
  });
}

test('undo takes the last answer back', async () => {
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  const before = await it.system.state();
  await page.locator('#options button').last().click();
  await whenPage(page, (text) => document.getElementById('question').textContent !== text, before.query.text);
  const asked = (await it.system.state()).query.questions_asked;
  await button(page, 'Undo').click();
  await whenPage(page, (text) => document.getElementById('question').textContent === text, before.query.text);
  assert.ok((await it.system.state()).query.questions_asked < asked);
  await endSession(it.system);
  await page.context().close();
});

test('"None of these" refuses all that is on offer', async () => {
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  const { query } = await it.system.state();
  await button(page, 'None of these').click();
  await whenPage(page, (text) => document.getElementById('question').textContent !== text, query.text);
  await endSession(it.system);
  await page.context().close();
});

test('nothing was loaded from elsewhere, and no error was logged', () => {
  assert.deepEqual(it.browser.problems, []);
});
