// New settings are on trial: "Keep these settings?" counts down; without a yes the earlier ones
// come back, so that nobody is locked out by what they chose.

import { byId, make, setText } from './dom.js';
import { t, tn } from './i18n.js';
import { mark } from './question.js';
import { post } from './server.js';

export class Trial {
  constructor({ tell }) {
    this.tell = tell;
    this.card = byId('trial');
    this.left = null;
    this.tried = null;  // settings on trial, as JSON
  }

  /** `reply` of GET /api/settings: whether they were kept, in whatever way, shows here. */
  settled({ trial, settings }) {
    const now = JSON.stringify(settings);
    if (trial) {
      this.tried = now;
    } else if (this.tried !== null) {
      this.tell(t(this.tried === now ? 'trial.kept' : 'trial.back'));
      this.tried = null;
    }
  }

  update({ settings_trial: trial, highlight, scanning }) {
    const left = trial?.seconds_left ?? null;
    if (left === null) {
      if (this.left !== null) this.end();
    } else {
      if (this.left === null) this.begin();
      this.show(left);
    }
    this.left = left;
    for (const each of this.card.querySelectorAll('[data-control]')) {
      if (each.dataset.control === 'revert') each.hidden = !scanning;
      mark(each, highlight?.controls.includes(each.dataset.control) ?? false, highlight);
    }
  }

  begin() {
    this.until = null;
    this.text = make('p', { class: 'large' });
    this.card.replaceChildren(this.text, make('div', { class: 'row' },
      make('button', { type: 'button', id: 'keep', class: 'main', 'data-control': 'keep',
        on: { click: () => this.keep() } }, t('trial.keep')),
      make('p', { class: 'chip', 'data-control': 'revert' }, t('trial.revert'))));
    this.card.hidden = false;
    this.tell(`${t('trial.question')} ${t('trial.else')}`);
  }

  /** The server says how long at the trial's start and whenever it says anything; between, the page
   * counts by itself. */
  show(left) {
    const until = performance.now() + 1000 * left;
    if (this.until === null || Math.abs(until - this.until) > 1100) this.until = until;
    clearInterval(this.timer);
    this.timer = setInterval(() => this.count(), 250);
    this.count();
  }

  count() {
    const left = Math.max(0, Math.ceil((this.until - performance.now()) / 1000));
    setText(this.text, `${t('trial.question')} ${tn('trial.left', left)}`);
  }

  end() {
    clearInterval(this.timer);
    this.card.hidden = true;
    this.tell('');
  }

  async keep() {
    const answer = await post('/api/settings/keep');
    if (!answer.ok) this.tell(t('error.not_done', { error: answer.error }));
  }
}
