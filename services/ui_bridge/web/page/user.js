// "Who am I?": somebody from the list of those that have a past, or a new name.

import { byId, make } from './dom.js';
import { t } from './i18n.js';
import { post } from './server.js';

const NAME = /^[A-Za-z0-9_.-]{1,64}$/;

export class User {
  /** `done()`: a user was chosen. */
  constructor({ tell, done }) {
    this.section = byId('view-user');
    this.tell = tell;
    this.done = done;
  }

  update(profile, user) {
    const key = JSON.stringify([profile?.users, user, document.documentElement.lang]);
    if (key === this.key) return;
    this.key = key;
    const others = [...new Set([user, ...(profile?.users ?? [])])];
    this.input = make('input', { id: 'new-user', name: 'user', autocomplete: 'off', maxlength: '64',
      autocapitalize: 'none', spellcheck: 'false', 'aria-describedby': 'new-user-hint new-user-error' });
    this.error = make('p', { id: 'new-user-error', class: 'error', role: 'alert' });
    this.section.replaceChildren(
      make('h1', { id: 'user-title', tabindex: '-1' }, t('user.title')),
      make('p', {}, t('user.now', { user })),
      make('ul', { class: 'choices' }, ...others.map((name) => make('li', {}, this.button(name, user)))),
      make('form', { class: 'card', novalidate: true, on: { submit: (event) => this.submit(event) } },
        make('label', { for: 'new-user' }, t('user.new')),
        this.input,
        make('p', { id: 'new-user-hint', class: 'small' }, t('user.hint')),
        this.error,
        make('button', { type: 'submit' }, t('user.use'))));
  }

  button(name, user) {
    return make('button', { type: 'button', 'aria-pressed': String(name === user),
      on: { click: () => this.choose(name) } }, name);
  }

  submit(event) {
    event.preventDefault();
    const name = this.input.value.trim();
    if (NAME.test(name)) {
      this.choose(name);
      return;
    }
    this.error.textContent = t('user.bad');
    this.input.setAttribute('aria-invalid', 'true');
    this.input.focus();
  }

  async choose(name) {
    const answer = await post('/api/user', { user: name });
    if (answer.ok) this.done();
    else this.tell(t('error.not_done', { error: answer.error }));
  }
}
