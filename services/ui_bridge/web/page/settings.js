// Settings: a form with presets for each way of access. They are tried for a while before they are
// kept (trial.js), and the server says what is wrong with them.

import { byId, make } from './dom.js';
import { languages, t } from './i18n.js';
import { put } from './server.js';

const NUMBER = 'number';

// Each: path in the settings, and either its choices or [least, most, step] and its unit.
const GROUPS = [
  ['settings.look', [
    ['theme', ['auto', 'light', 'dark', 'contrast']],
    ['text_percent', NUMBER, [100, 250, 10], '%'],
    ['language', () => ['auto', ...languages()]],
    ['motion', ['auto', 'reduced', 'full']],
    ['show.picture', 'check'],
    ['show.shapes', 'check'],
  ]],
  ['settings.pointing', [
    ['dwell_s', NUMBER, [0, 5, 0.1], 's'],
  ]],
  ['settings.scanning', [
    ['scan.method', ['automatic', 'step', 'inverse']],
    ['scan.grouping', ['linear', 'row_column', 'binary']],
    ['scan.scan_time_s', NUMBER, [0.2, 20, 0.1], 's'],
    ['scan.first_item_delay_s', NUMBER, [0, 10, 0.1], 's'],
    ['scan.hold_s', NUMBER, [0, 5, 0.05], 's'],
    ['scan.ignore_repeat_s', NUMBER, [0, 5, 0.05], 's'],
    ['scan.rounds', NUMBER, [0, 20, 1], ''],
    ['scan.stop_hold_s', NUMBER, [0, 20, 0.5], 's'],
  ]],
];

const ACCESS = ['pointer', 'keyboard', 'one_switch', 'two_switches', 'gaze'];  // first, in this order

const read = (settings, path) => path.split('.').reduce((part, key) => part?.[key], settings);

function write(settings, path, value) {
  const keys = path.split('.');
  const last = keys.pop();
  let part = settings;
  for (const key of keys) part = part[key] ??= {};
  part[last] = value;
}

export class Settings {
  constructor() {
    this.section = byId('view-settings');
  }

  /** `reply` of GET /api/settings. */
  update(reply) {
    const key = JSON.stringify([reply, document.documentElement.lang]);
    if (key === this.key || !reply) return;
    this.key = key;
    this.reply = reply;
    this.settings = structuredClone(reply.settings);
    this.build();
  }

  build() {
    this.error = make('p', { class: 'error', role: 'alert', id: 'settings-error' });
    this.form = make('form', { novalidate: true, on: { submit: (event) => this.submit(event) } },
      this.presets(),
      ...GROUPS.map(([title, fields]) => this.group(title, fields)),
      this.error,
      make('p', { class: 'small' }, t('settings.how')),
      make('button', { type: 'submit', class: 'main' }, t('settings.try')));
    this.section.replaceChildren(
      make('h1', { id: 'settings-title', tabindex: '-1' }, t('settings.title')), this.form);
  }

  presets() {
    const offered = Object.keys(this.reply.presets ?? {});
    const names = [...ACCESS.filter((name) => offered.includes(name)), ...offered.filter((name) => !ACCESS.includes(name))];
    return make('fieldset', { class: 'card' }, make('legend', {}, t('settings.access')),
      make('p', { class: 'small' }, t('settings.presets')),
      make('div', { class: 'choices' }, ...names.map((name) => this.radio('access', name))));
  }

  group(title, fields) {
    const known = fields.filter(([path]) => read(this.settings, path) !== undefined);
    return make('fieldset', { class: 'card' }, make('legend', {}, t(title)),
      ...known.map((field) => this.field(...field)));
  }

  field(path, kind, range, unit) {
    const id = `set-${path.replace('.', '-')}`;
    const label = t(`settings.${path}`);
    if (kind === 'check') {
      const input = make('input', { type: 'checkbox', id, on: {
        change: () => write(this.settings, path, input.checked) } });
      input.checked = read(this.settings, path);
      return make('label', { class: 'check', for: id }, input, make('span', {}, label));
    }
    if (kind === NUMBER) return this.numberField(path, id, label, range, unit);
    const values = typeof kind === 'function' ? kind() : kind;
    return make('div', { role: 'radiogroup', class: 'radios', 'aria-label': label },
      make('span', { 'aria-hidden': 'true' }, label),
      make('div', { class: 'choices' }, ...values.map((value) => this.radio(path, value))));
  }

  numberField(path, id, label, [least, most, step], unit) {
    const input = make('input', { type: 'number', id, min: least, max: most, step, inputmode: 'decimal',
      value: read(this.settings, path), 'aria-describedby': `${id}-hint` });
    const set = (value) => {
      const rounded = Number(Math.min(most, Math.max(least, value)).toFixed(2));
      input.value = rounded;
      write(this.settings, path, rounded);
    };
    const stepper = (sign, name) => make('button', { type: 'button', 'aria-label': t(name, { label }),
      on: { click: () => set(Number(input.value) + sign * step) } }, sign > 0 ? '+' : '−');
    input.addEventListener('change', () => write(this.settings, path, Number(input.value)));
    return make('div', { class: 'number' },
      make('label', { for: id }, label),
      make('span', { class: 'small', id: `${id}-hint` }, t(`settings.hint.${path}`, {}, `${least} – ${most} ${unit}`)),
      make('span', { class: 'row' }, stepper(-1, 'settings.less'), input, stepper(1, 'settings.more')));
  }

  radio(path, value) {
    const isAccess = path === 'access';
    const input = make('input', { type: 'radio', name: path, value, on: {
      change: () => (isAccess ? this.usePreset(value) : write(this.settings, path, value)) } });
    input.checked = read(this.settings, path) === value;
    const text = t(`settings.${path}.${value}`, {}, value);
    return make('label', { class: 'radio' }, input, make('span', {}, text));
  }

  /** Fills the form with what suits an access method; the look stays as the user has it. */
  usePreset(name) {
    const { theme, language, text_percent: textPercent } = this.settings;
    this.settings = { ...structuredClone(this.reply.presets[name]), theme, language, access: name };
    this.settings.text_percent = Math.max(textPercent, this.settings.text_percent ?? 100);
    this.build();
    this.form.querySelector(`input[name=access][value=${name}]`).focus();
  }

  async submit(event) {
    event.preventDefault();
    this.error.textContent = '';
    const answer = await put('/api/settings', { settings: this.settings });
    if (!answer.ok) {
      this.error.textContent = t('settings.wrong', { error: answer.error });
      this.error.scrollIntoView({ block: 'nearest' });
    }
  }
}
