// "Why this question?": the reason in words, the likeliest tasks with bars, and what each answer
// would leave to ask.

import { byId, make } from './dom.js';
import { number, pair, percent, t, tn } from './i18n.js';
import { optionText } from './question.js';

export class Why {
  constructor({ partner }) {
    this.partner = partner;
    this.open = partner;
    this.toggle = make('button', {
      type: 'button', 'aria-expanded': String(this.open), 'aria-controls': 'why-panel',
      on: { click: () => this.setOpen(!this.open) } });
    this.panel = make('div', { id: 'why-panel', class: 'card' });
    byId('why').append(partner ? '' : this.toggle, this.panel);
  }

  setOpen(open) {
    this.open = open;
    this.toggle.setAttribute('aria-expanded', String(open));
    this.panel.hidden = !open;
    this.key = null;
    this.update(this.state);
  }

  update(state) {
    this.state = state;
    const query = state.query;
    byId('why').hidden = !query;
    if (!query) return;
    this.toggle.textContent = t('why.title');
    this.panel.hidden = !this.open;
    const key = `${query.id} ${document.documentElement.lang}`;
    if (!this.open || key === this.key) return;
    this.key = key;
    this.panel.replaceChildren(
      make('h2', {}, t('why.title')),
      query.why ? make('p', {}, query.why) : '',
      make('p', {}, this.facts(query)),
      ...this.likeliest(query),
      ...this.prospects(query));
  }

  facts(query) {
    const left = number(query.expected_questions, 1);
    return `${tn('why.asked', query.questions_asked)} ${t('why.left', { left })} ` +
      tn('why.candidates', query.n_candidates);
  }

  likeliest(query) {
    if (!query.likeliest?.length) return [];
    const rows = query.likeliest.map((task) => make('li', {},
      make('span', { class: 'what' }, pair(task, task.instance > 1)),
      bar(task.posterior, task.prior),
      make('span', { class: 'much' }, percent(task.posterior)),
      make('span', { class: 'past' }, this.past(task))));
    return [make('h3', {}, t('why.likeliest')), make('ul', { class: 'bars' }, ...rows),
      make('p', { class: 'small' }, t('why.bars'))];
  }

  past({ times, sessions_ago: ago }) {
    if (!times) return t('why.never');
    return `${tn('why.times', times)}, ${ago === 1 ? t('why.last_time') : t('why.ago', { n: ago })}`;
  }

  prospects(query) {
    const known = query.options.filter((option) => option.questions_left !== undefined &&
      option.questions_left !== null);
    if (known.length === 0) return [];
    const rows = query.options.map((option, i) => make('tr', {},
      make('th', { scope: 'row' }, optionText(query, i)),
      make('td', {}, percent(option.probability)),
      make('td', {}, number(option.questions_left, 1))));
    return [make('h3', { id: 'why-answers' }, t('why.answers')),
      make('table', { 'aria-labelledby': 'why-answers' },
        make('thead', {}, make('tr', {}, ...['why.answer', 'why.probability', 'why.questions_left']
          .map((key) => make('th', { scope: 'col' }, t(key))))),
        make('tbody', {}, ...rows))];
  }
}

/** How likely now (bar) and before the first answer (line). */
function bar(now, before) {
  const shown = make('span', { class: 'bar', 'aria-hidden': 'true' }, make('i'), make('b'));
  shown.style.setProperty('--now', `${100 * now}%`);
  shown.style.setProperty('--before', `${100 * before}%`);
  return shown;
}
