// How long from the press of an answer to the next question on the page (the text in the document
// changed), in the browser's own time: quantiles as one line of JSON.
//   tests/browser/run --latency [ANSWERS]

import { Browser, button, whenPage } from './browser.mjs';
import { System, until } from './system.mjs';

const ANSWERS = Number(process.argv[2] ?? 200);

const quantile = (sorted, q) => sorted[Math.min(sorted.length - 1, Math.floor(q * sorted.length))];

/** Presses the option as soon as it may be; ms until the question's text changed; null where the
 * session ended instead. */
const answerOnce = (page, last) => page.evaluate((takesLast) => new Promise((resolve) => {
  const question = document.getElementById('question');
  const buttons = document.querySelectorAll('#options button');
  const target = buttons[takesLast ? buttons.length - 1 : 0];
  let pressed = 0;
  const observer = new MutationObserver(() => {
    const isQuestion = document.querySelector('#options button') !== null;
    observer.disconnect();
    resolve(isQuestion ? performance.now() - pressed : null);
  });
  observer.observe(question, { childList: true, characterData: true, subtree: true });
  pressed = performance.now();
  target.click();
  setTimeout(() => resolve(null), 5000);
}), last);

const system = await System.start();
const browser = await Browser.start();
try {
  const page = await browser.open(system.url);
  const times = [];
  while (times.length < ANSWERS) {
    const isReady = () => document.querySelector('#options button[aria-disabled=false], [data-control=start]');
    await whenPage(page, isReady);
    if ((await page.locator('#options button').count()) === 0) {
      await button(page, 'New task').click({ timeout: 1000 }).catch(() => {});
      await until(async () => (await system.state()).query, 'a question');
      continue;
    }
    const ms = await answerOnce(page, true);
    if (ms !== null) times.push(ms);
    if (times.length % 5 === 4) await system.send('POST', 'api/request', { request: 'cancel' });
  }
  times.sort((a, b) => a - b);
  const [p50, p95, most] = [quantile(times, 0.5), quantile(times, 0.95), times.at(-1)].map((ms) => Number(ms.toFixed(1)));
  console.log(JSON.stringify({ answers: times.length, answer_to_question_ms: { p50, p95, max: most } }));
} finally {
  await browser.stop();
  await system.stop();
}
