// Pages over time: two at once, restarts of what is behind them, another user, another language.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { button, heading, whenPage } from './browser.mjs';
import { byMouse, Person } from './person.mjs';
import { endSession, useSystem } from './setup.mjs';
import { until } from './system.mjs';

const it = useSystem();
const WANT = { action: 'Open', category: 'Carton' };

const shows = (page, text) => whenPage(page, (t) => document.getElementById('question').textContent === t, text);

test('of two pages that answer one question the first counts, and both go on', async () => {
  const one = await it.browser.open(it.system.url, { quiet: true });
  await one.locator('#options button[aria-disabled=false]').first().waitFor();
  const two = await it.browser.open(it.system.url, { quiet: true });
  await two.locator('#options button[aria-disabled=false]').first().waitFor();
  const { query } = await it.system.state();
  await Promise.all([shows(one, query.text), shows(two, query.text)]);
  for (const page of [one, two]) await page.locator('#options button[aria-disabled=false]').first().waitFor();
  const statuses = [];
  for (const page of [one, two]) {
    page.on('response', (response) => response.url().endsWith('/api/answer') && statuses.push(response.status()));
  }
  await Promise.all([one, two].map((page) => page.evaluate(() => document.querySelector('#options button:last-child').click())));
  const next = await until(async () => {
    const state = await it.system.state();
    return state.query && state.query.id !== query.id ? state : null;
  }, 'the next question');
  assert.equal(next.query.questions_asked, query.questions_asked + 1, 'one answer was taken');
  await Promise.all([shows(one, next.query.text), shows(two, next.query.text)]);
  await until(() => statuses.length > 0, 'responses');
  assert.equal(statuses.filter((status) => status === 200).length, 1, String(statuses));
  await two.context().close();
  const person = new Person(it.system, one, WANT);
  await endSession(it.system);
  await button(one, 'New task').click();
  assert.equal((await person.converse(byMouse(one))).event.kind, 'confirmed');
  await one.context().close();
});

test('a press that began before a question was shown does not answer it', async () => {
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  const { query } = await it.system.state();
  await shows(page, query.text);
  const no = await page.locator('#options button').last().boundingBox();
  await page.mouse.move(no.x + no.width / 2, no.y + no.height / 2);
  await page.mouse.down();
  await it.system.send('POST', 'api/answer', { query_id: query.id, option: query.options.length - 1 });
  const next = await until(async () => {
    const state = await it.system.state();
    return state.query && state.query.id !== query.id ? state : null;
  }, 'the next question');
  await shows(page, next.query.text);
  await page.mouse.up();
  await page.waitForTimeout(150);  // time in which an answer would come
  assert.equal((await it.system.state()).query.id, next.query.id);
  await endSession(it.system);
  await page.context().close();
});

test('a question that comes by itself takes the focus off the answers, and no quick press answers it', async () => {
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  const { query } = await it.system.state();
  await page.locator('#options button').last().focus();
  const answers = [];
  page.on('request', (request) => request.url().endsWith('/api/answer') && answers.push(request.postDataJSON()));
  // In the moment in which the next question is there somebody presses what the focus is on, and clicks.
  await page.evaluate(() => new MutationObserver(() => {
    document.activeElement.click();
    document.querySelector('#options button')?.click();
  }).observe(document.getElementById('options'), { attributes: true, attributeFilter: ['data-query'] }));
  await it.system.send('POST', 'api/answer', { query_id: query.id, option: query.options.length - 1 });
  await whenPage(page, (id) => document.querySelector(`#options:not([data-query="${id}"]) button[aria-disabled=false]`), query.id);
  assert.equal(await page.evaluate(() => document.activeElement.id), 'question');
  assert.deepEqual(answers, []);
  await endSession(it.system);
  await page.context().close();
});

test('a page left open finds its way back after ui_bridge was killed, and says so meanwhile', async () => {
  const page = await it.browser.open(it.system.url, { quiet: true });
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  await it.system.kill('ui_bridge');
  await page.getByText('Not connected. Trying again').waitFor();
  assert.equal(await page.locator('#options button').first().getAttribute('aria-disabled'), 'true');
  it.system.launch('ui_bridge');
  await page.getByText('Connected ·').waitFor();
  await page.locator('#options button, [data-control=start]').first().waitFor();
  const person = new Person(it.system, page, WANT);
  await person.begin((target) => target.click({ timeout: 1000 }));
  assert.equal((await person.converse(byMouse(page))).event.kind, 'confirmed');
  await page.context().close();
});

test('a page left open finds its way back after intention was killed', async () => {
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  await it.system.kill('intention');
  await page.getByText('nothing decides what to ask').waitFor();
  it.system.launch('intention');
  await page.getByText('Connected ·').waitFor();
  const person = new Person(it.system, page, WANT);
  await person.begin((target) => target.click({ timeout: 1000 }));
  assert.equal((await person.converse(byMouse(page))).event.kind, 'confirmed');
  await page.context().close();
});

test('the picture shows what is on the table, and what the question is about', async () => {
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  await page.locator('#picture .frame img').waitFor();
  await whenPage(page, () => document.querySelector('#picture img').naturalWidth === 640);
  const { scene } = await it.system.state();
  assert.equal(await page.locator('#picture polygon.over').count() > 0, true);
  assert.equal(await page.locator('#picture text').count(), scene.objects.length);
  await whenPage(page, () => document.querySelectorAll('#picture path.shape').length > 0);
  const label = await page.locator('#picture svg').getAttribute('aria-label');
  assert.match(label, /^On the table: .*carton/);
  await endSession(it.system);
  await page.context().close();
});

test('superquadrics are drawn where the objects are', async () => {
  const page = await it.browser.open(it.system.url);
  await whenPage(page, () => document.querySelectorAll('#picture path.shape').length > 2);
  const { scene } = await it.system.state();
  const boxes = await page.locator('#picture path.shape').evaluateAll((paths) => paths.map((path) => {
    const { x, y, width, height } = path.getBBox();
    return { u: x + width / 2, v: y + height / 2, width, height };
  }));
  const shapes = scene.superquadrics.filter((each) => each.converged);
  assert.equal(boxes.length, shapes.length);
  shapes.forEach((shape, i) => {
    const { outline_px: outline } = scene.objects.find((each) => each.id === shape.object_id);
    const [us, vs] = [0, 1].map((k) => outline.map((point) => point[k]));
    const [width, height] = [us, vs].map((all) => Math.max(...all) - Math.min(...all));
    const off = Math.hypot(boxes[i].u - (Math.min(...us) + width / 2), boxes[i].v - (Math.min(...vs) + height / 2));
    assert.ok(off < 0.35 * Math.hypot(width, height), `shape ${shape.object_id} is ${Math.round(off)} px off`);
  });
  await endSession(it.system);
  await page.context().close();
});

test('"Why this question?" tells the reason, the likeliest tasks and what each answer leaves', async () => {
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  await button(page, 'Why this question?').click();
  const { query } = await it.system.state();
  assert.ok((await page.locator('#why-panel').textContent()).includes(query.why));
  assert.equal(await page.locator('#why-panel .bars li').count(), query.likeliest.length);
  assert.equal(await page.locator('#why-panel tbody tr').count(), query.options.length);
  await endSession(it.system);
  await page.context().close();
});

test('another user is chosen by name, has a history of their own, and the page says whose questions they are', async () => {
  const page = await it.browser.open(it.system.url);
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  await button(page, 'Who am I?').click();
  await page.getByLabel('Another name').fill('Jörg');
  await button(page, 'Use this name').click();
  await page.getByText('This is no name').waitFor();
  await page.getByLabel('Another name').fill('bob');
  await button(page, 'Use this name').click();
  await page.getByText('Connected · bob').waitFor();
  assert.equal((await it.system.state()).user, 'bob');
  const person = new Person(it.system, page, WANT);
  await button(page, 'New task').or(page.locator('#options button').first()).first().waitFor();
  await person.begin((target) => target.click({ timeout: 1000 }));
  assert.equal((await person.converse(byMouse(page))).event.kind, 'confirmed');
  await button(page, 'History').click();
  await heading(page).filter({ hasText: 'History of bob' }).waitFor();
  await page.locator('.plot circle').first().waitFor();
  assert.equal(await page.locator('.plot circle').count(), 1);
  await page.getByText('The same as a table').click();
  assert.equal(await page.locator('#view-history tbody tr').count(), 1);
  await button(page, 'Who am I?').click();
  await button(page, 'ann').click();
  await page.getByText('Connected · ann').waitFor();
  await page.context().close();
});

test('the page speaks the browser’s language, or the one of the address', async () => {
  const german = await it.browser.open(it.system.url, { locale: 'de-AT' });
  await button(german, 'Stopp').waitFor();
  assert.equal(await german.locator('html').getAttribute('lang'), 'de');
  await button(german, 'Einstellungen').click();
  await heading(german).filter({ hasText: 'Einstellungen' }).waitFor();
  await german.context().close();
  const french = await it.browser.open(it.system.url, { locale: 'fr-FR' });
  await button(french, 'Stop').waitFor();
  assert.equal(await french.locator('html').getAttribute('lang'), 'en');
  await french.context().close();
  const address = await it.browser.open(`${it.system.url}?lang=de&theme=contrast&text=150`);
  await button(address, 'Stopp').waitFor();
  assert.equal(await address.locator('html').getAttribute('data-theme'), 'contrast');
  assert.equal(await address.evaluate(() => getComputedStyle(document.documentElement).fontSize), '24px');
  await endSession(it.system);
  await address.context().close();
});

test('until the first question less than 200 kB come besides pictures, 100 kB of them the page itself', async () => {
  await endSession(it.system);
  const page = await it.browser.open('about:blank');
  const session = await page.context().newCDPSession(page);
  const bytes = { page: 0, api: 0, pictures: 0 };
  const kinds = new Map();
  const kindOf = (url) => (url.includes('/api/frame') ? 'pictures' : url.includes('/api/') ? 'api' : 'page');
  await session.send('Network.enable');
  session.on('Network.requestWillBeSent', ({ requestId, request }) => kinds.set(requestId, kindOf(request.url)));
  session.on('Network.dataReceived', ({ requestId, dataLength }) => (bytes[kinds.get(requestId)] += dataLength));
  await page.goto(it.system.url, { waitUntil: 'commit' });
  await page.locator('#options button[aria-disabled=false]').first().waitFor();
  console.log(`# ${JSON.stringify(bytes)}`);
  assert.ok(bytes.page > 10000 && bytes.page < 100000, `the page itself: ${bytes.page} bytes`);
  assert.ok(bytes.api > 1000 && bytes.page + bytes.api < 200000, `all: ${bytes.page + bytes.api} bytes`);
  await page.context().close();
});

test('nothing was loaded from elsewhere, and no error was logged', () => {
  assert.deepEqual(it.browser.problems, []);
});
