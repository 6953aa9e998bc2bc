// Stop, from anywhere by one press or by Escape, and the view after it with a two-step Resume.

import { byId, make, setText } from './dom.js';
import { t } from './i18n.js';
import { mark } from './question.js';
import { request } from './server.js';

const INSIST_MS = 500;
const INSIST_FOR_MS = 10000;  // a stop that could not be sent is tried again for so long

export class Stop {
  constructor({ tell }) {
    this.tell = tell;
    this.asking = false;
    this.button = byId('stop');
    this.section = byId('view-stopped');
    this.button.addEventListener('click', () => this.stop());
    document.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape') return;
      event.preventDefault();
      event.stopImmediatePropagation();
      if (!event.repeat) this.stop();
    }, true);
  }

  async stop() {
    const until = performance.now() + INSIST_FOR_MS;
    this.button.classList.add('sent');
    for (;;) {
      const answer = await request('stop');
      if (answer.ok) break;
      this.tell(t('stop.failed', { error: answer.error }));
      if (performance.now() > until) break;
      await new Promise((resolve) => setTimeout(resolve, INSIST_MS));
    }
    this.button.classList.remove('sent');
  }

  update({ stopped, stopping, highlight }, partner) {
    mark(this.button, highlight?.controls.includes('stop') ?? false, highlight);
    this.stopped = stopped;
    if (!stopped && !stopping) {
      this.asking = false;
      this.key = null;
      return;
    }
    this.scanned = Boolean(highlight);
    this.partner = partner;
    if (this.keyNow() !== this.key) this.show();
    for (const each of this.section.querySelectorAll('[data-control]')) {
      mark(each, highlight?.controls.includes(each.dataset.control) ?? false, highlight);
    }
  }

  keyNow() {
    return [this.stopped, this.asking, this.scanned, document.documentElement.lang].join();
  }

  show() {
    this.key = this.keyNow();
    const hadFocus = this.section.contains(document.activeElement);
    const title = make('h1', { id: 'stopped-title', tabindex: '-1' }, t(this.stopped ? 'stopped.title' : 'stopped.soon'));
    const text = make('p', { class: 'large' }, t(this.stopped ? 'stopped.text' : 'stopped.soon_text'));
    const steps = this.partner || !this.stopped ? [] : this.asking ? this.secondStep() : this.firstStep();
    this.section.replaceChildren(make('div', { role: 'status', 'aria-live': 'assertive' }, title, text), ...steps);
    if (hadFocus) title.focus();
  }

  /** A switch chooses "resume" here twice, or "stay". */
  firstStep() {
    return [make('div', { class: 'row' },
      make('button', { type: 'button', id: 'resume', 'data-control': 'resume',
        on: { click: () => this.ask(true) } }, t('resume')),
      this.scanned ? make('p', { class: 'chip', 'data-control': 'stay' }, t('resume.stay')) : '')];
  }

  secondStep() {
    return [make('p', { id: 'resume-question', class: 'large', tabindex: '-1' }, t('resume.question')),
      make('div', { class: 'row', role: 'group', 'aria-labelledby': 'resume-question' },
        make('button', { type: 'button', id: 'stay', 'data-control': 'stay', on: { click: () => this.ask(false) } }, t('resume.stay')),
        make('button', { type: 'button', id: 'really', 'data-control': 'resume',
          on: { click: () => this.resume() } }, t('resume.really')))];
  }

  ask(asking) {
    this.asking = asking;
    this.show();
    byId(asking ? 'resume-question' : 'resume').focus();
  }

  async resume() {
    const answer = await request('resume', { confirm: true });
    if (!answer.ok) this.tell(t('error.not_done', { error: answer.error }));
  }
}

/** What the line at the bottom says. */
export function showStatus({ connected, state }) {
  let text = t('status.offline');
  if (connected) text = state?.intention_silent ? t('status.silent') : t('status.connected', { user: state?.user ?? '' });
  setText(byId('status'), text);
}
