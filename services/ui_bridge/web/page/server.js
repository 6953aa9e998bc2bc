// What the page asks of the server, each with a deadline and with errors in words.

import { t } from './i18n.js';

const DEADLINE_MS = 4000;

async function call(method, path, body) {
  const options = { method, signal: AbortSignal.timeout(DEADLINE_MS), cache: 'no-store' };
  if (body !== undefined) {
    options.headers = { 'Content-Type': 'application/json' };
    options.body = JSON.stringify(body);
  }
  let response;
  try {
    response = await fetch(path, options);
  } catch {
    return { ok: false, status: 0, error: t('error.unreachable'), body: {} };
  }
  const answer = await response.json().catch(() => ({}));
  const error = response.ok ? '' : answer.error ?? t('error.http', { status: response.status });
  return { ok: response.ok, status: response.status, error, body: answer };
}

/** Each gives {ok, status (0: not reached), error: for people, body}. */
export const get = (path) => call('GET', path);
export const post = (path, body = {}) => call('POST', path, body);
export const put = (path, body) => call('PUT', path, body);

export const request = (what, more = {}) => post('/api/request', { request: what, ...more });
