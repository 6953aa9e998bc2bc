// The question, its answers as buttons, and what else can be said: undo, none of these.

import { byId, make, setText } from './dom.js';
import { currentLanguage, pair, t, tn } from './i18n.js';
import { post, request } from './server.js';

const YES_NO = new Set(['action', 'object', 'full', 'category', 'set']);
// After a new question presses count for nothing for a moment: they were meant for the one before.
// Where it came by itself (the table changed, another page answered) nobody waits for it: longer.
const GUARD_MS = { expected: 150, unexpected: 600 };
const REQUESTS = { undo: 'undo', none: 'none_of_these', start: 'start' };  // by control

/** Whether the option says that none of the others holds. */
export function isNone(query, option) {
  if (query.kind === 'what_is_it') return option.category === 'Unknown';
  return query.kind === 'choice' && !option.actions?.length && !option.objects?.length;
}

/** The option as its button says it. */
export function optionText(query, index) {
  if (YES_NO.has(query.kind)) return t(index === 0 ? 'yes' : 'no');
  return query.options[index].text;
}

export class Question {
  /** `tell(text)` shows a line to the user. */
  constructor({ partner, tell }) {
    this.partner = partner;
    this.tell = tell;
    this.shown = null;       // id of the query whose options are shown
    this.pressedFor = null;  // the query that stood when the pointer or key went down
    this.chosen = null;      // {id, index} that was sent
    this.acted = true;       // this page asked for what comes next
    this.guardUntil = 0;
    this.heading = byId('question');
    this.options = byId('options');
    this.controls = byId('controls');
    for (const event of ['pointerdown', 'keydown']) {
      this.options.addEventListener(event, () => (this.pressedFor = this.shown), true);
    }
    if (partner) this.controls.hidden = true;
  }

  update(state, connected) {
    this.connected = connected;
    this.state = state;
    this.showHeading(state);
    this.showOptions(state);
    if (!this.partner) this.showControls(state);
  }

  showHeading({ query, event, task, phase }) {
    const text = query ? query.text : this.withoutQuestion(event, phase);
    const several = query && !YES_NO.has(query.kind);
    setText(byId('hint'), several ? tn('choose', query.options.length) : '');
    setText(this.heading, text);
    const line = byId('task');
    const known = !query && task;
    line.hidden = !known;
    if (known) setText(line, this.taskText(task));
  }

  withoutQuestion(event, phase) {
    const isOver = ['confirmed', 'abandoned', 'stopped'].includes(event?.kind);
    if (phase === 'running' || !isOver) return event?.text || t('wait');
    return event.kind === 'confirmed' ? t('task.understood') : event.text || t('task.over');
  }

  taskText(task) {
    const state = t(`robot.${task.state ?? 'told'}`);
    return `${pair(task)} – ${state}${task.text ? ` (${task.text})` : ''}`;
  }

  showOptions({ query, highlight }) {
    const id = query?.id ?? null;
    const words = currentLanguage();
    const isNew = id !== null && id !== this.latest;
    if (id === null || this.shown !== id || this.words !== words) this.buildOptions(query);
    if (isNew) this.guard(id);
    this.shown = id;
    this.words = words;
    if (this.options.dataset.query !== String(id ?? '')) this.options.dataset.query = id ?? '';
    if (query === null) return;
    const lit = new Set(highlight?.options ?? []);
    const sent = this.chosen?.id === id ? this.chosen.index : null;
    [...this.options.children].forEach((button, index) => {
      mark(button, lit.has(index), highlight);
      if (this.partner) return;
      const isOff = query.answered || sent !== null || !this.connected || performance.now() < this.guardUntil;
      button.setAttribute('aria-disabled', String(isOff));
      button.classList.toggle('chosen', sent === index);
    });
  }

  guard(id) {
    const ms = this.acted ? GUARD_MS.expected : GUARD_MS.unexpected;
    this.latest = id;
    this.acted = false;
    this.guardUntil = performance.now() + ms;
    setTimeout(() => this.update(this.state, this.connected), ms + 1);
  }

  /** Buttons of the same two answers stay, and so does the focus on them where the question was
   * expected; else it goes to the question, so that no key answers what was not read. */
  buildOptions(query) {
    const hadFocus = this.options.contains(document.activeElement);
    const isYesNo = query !== null && YES_NO.has(query.kind);
    const stays = isYesNo && this.options.dataset.kind === 'yes_no';
    const sent = this.chosen?.id === query?.id ? this.chosen : null;
    this.options.dataset.kind = query === null ? '' : isYesNo ? 'yes_no' : 'list';
    this.chosen = sent;
    if (stays) {
      [...this.options.children].forEach((child, i) =>
        setText(child.querySelector('.name') ?? child, optionText(query, i)));
      if (hadFocus && !this.acted && query.id !== this.latest) this.heading.focus();
      return;
    }
    const make_ = this.partner ? (i) => this.partnerOption(query, i) : (i) => this.button(query, i);
    this.options.replaceChildren(...(query?.options ?? []).map((_, i) => make_(i)));
    if (hadFocus) this.heading.focus();
  }

  button(query, index) {
    const isYesNo = YES_NO.has(query.kind);
    return make('button', {
      type: 'button', class: isYesNo ? ['yes', 'no'][index] : 'one',
      on: { click: (event) => this.choose(index, event) } },
    this.sign(query, index), ' ',
    make('span', { class: 'name' }, optionText(query, index)));
  }

  /** The number stands in the picture as well. */
  sign(query, index) {
    const sign = YES_NO.has(query.kind) ? ['✓', '✗'][index] : String(index + 1);
    return make('span', { class: 'sign', 'aria-hidden': 'true' }, sign);
  }

  partnerOption(query, index) {
    return make('p', { class: 'option' }, this.sign(query, index), ' ',
      make('span', { class: 'name' }, optionText(query, index)));
  }

  async choose(index, event) {
    const id = this.shown;
    const isPress = event.detail > 0 || this.pressedFor !== null;
    const isStale = isPress && this.pressedFor !== id;
    this.pressedFor = null;
    const button = this.options.children[index];
    if (id === null || isStale || button.getAttribute('aria-disabled') === 'true') return;
    this.chosen = { id, index };
    this.acted = true;
    for (const each of this.options.children) each.setAttribute('aria-disabled', 'true');
    button.classList.add('chosen');
    const answer = await post('/api/answer', { query_id: id, option: index });
    if (answer.ok) return;
    if (this.chosen?.id === id) this.chosen = null;
    this.tell(answer.status === 409 ? t(`answer.${answer.body.reason ?? 'stale'}`)
      : t('error.not_said', { error: answer.error }));
    for (const each of this.options.children) {
      each.setAttribute('aria-disabled', String(answer.status === 409));
      each.classList.remove('chosen');
    }
  }

  showControls(state) {
    const { query, highlight, phase, stopped } = state;
    const saysNone = query?.options.some((option) => isNone(query, option)) ?? false;
    const names = [];
    if (phase === 'running') names.push('undo');
    if (query && !saysNone) names.push('none');
    if (phase === 'idle' && !stopped) names.push('start');
    if (state.scanning && state.controls?.includes('pause')) names.push('pause');
    if (highlight?.controls.includes('back')) names.push('back');
    if (this.controls.dataset.names !== names.join()) {
      this.controls.dataset.names = names.join();
      const existing = new Map([...this.controls.children].map((e) => [e.dataset.control, e]));
      this.controls.replaceChildren(...names.map((n) => existing.get(n) ?? this.control(n)));
    }
    for (const child of this.controls.children) {
      setText(child, t(`control.${child.dataset.control}`));
      mark(child, highlight?.controls.includes(child.dataset.control) ?? false, highlight);
    }
  }

  control(name) {
    if (!(name in REQUESTS)) return make('p', { 'data-control': name, class: 'chip' });
    const what = REQUESTS[name];
    const say = async () => {
      this.acted = true;
      const answer = await request(what);
      if (!answer.ok) this.tell(t('error.not_said', { error: answer.error }));
    };
    return make('button', { type: 'button', 'data-control': name, on: { click: say } });
  }
}

/** Shows that a switch would choose this now, by more than colour. */
export function mark(element, isLit, highlight) {
  element.classList.toggle('lit', isLit);
  element.classList.toggle('pressed', isLit && Boolean(highlight?.pressed));
  element.classList.toggle('paused', isLit && Boolean(highlight?.paused));
}
