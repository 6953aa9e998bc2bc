// What a file of tests works with: the running system and a browser, ended with the tests.

import { after, before } from 'node:test';
import { Browser } from './browser.mjs';
import { System } from './system.mjs';

/** `it.system` and `it.browser` are there once the tests run. */
export function useSystem(options) {
  const it = {};
  before(async () => {
    const [system, browser] = await Promise.allSettled([System.start(options), Browser.start()]);
    it.system = system.value;
    it.browser = browser.value;
    for (const { reason } of [system, browser]) if (reason) throw reason;
  });
  after(async () => {
    await it.browser?.stop();
    await it.system?.stop();
  });
  return it;
}

/** Ends what runs, so that the next page begins anew. */
export async function endSession(system) {
  await system.send('POST', 'api/request', { request: 'cancel' });
}
