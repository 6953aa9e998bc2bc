// The user's past: how many questions each session took, as a plot and as a table.

import { byId, draw, make } from './dom.js';
import { date, number, pair, t, tn } from './i18n.js';

const WIDTH = 640;
const HEIGHT = 260;
const LEFT = 44;
const BOTTOM = 40;
const TOP = 14;
const RIGHT = 12;

/** At most `n` whole numbers from `from` to `to`, evenly spread. */
export function ticks(from, to, n) {
  const step = Math.max(1, Math.ceil((to - from) / n));
  const values = [];
  for (let value = from; value <= to; value += step) values.push(value);
  return values;
}

export class History {
  constructor() {
    this.section = byId('view-history');
  }

  update(profile) {
    const title = make('h1', { id: 'history-title', tabindex: '-1' },
      t('history.title', { user: profile?.user ?? '' }));
    const recent = profile?.recent ?? [];
    if (recent.length === 0) {
      this.section.replaceChildren(title, make('p', {}, t('history.none')));
      return;
    }
    const first = profile.n_sessions - recent.length + 1;
    this.section.replaceChildren(title,
      make('p', {}, this.summary(profile)),
      make('figure', { class: 'plot' }, plot(recent, first)),
      make('details', {}, make('summary', {}, t('history.table')), table(recent, first)));
  }

  summary({ n_sessions: n, recent }) {
    const mean = recent.reduce((sum, each) => sum + each.questions, 0) / recent.length;
    return `${tn('history.sessions', n)} ${t('history.mean', { mean: number(mean, 1) })}`;
  }
}

function plot(recent, first) {
  const most = Math.max(4, ...recent.map((each) => each.questions));
  const n = recent.length;
  const x = (i) => LEFT + ((WIDTH - LEFT - RIGHT) * (n === 1 ? 0.5 : i / (n - 1)));
  const y = (questions) => TOP + (HEIGHT - TOP - BOTTOM) * (1 - questions / most);
  const svg = draw('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: 'img',
    'aria-label': t('history.plot', { n, last: recent[n - 1].questions }) });
  for (const value of ticks(0, most, 6)) {
    svg.append(draw('line', { x1: LEFT, x2: WIDTH - RIGHT, y1: y(value), y2: y(value), class: 'grid' }),
      draw('text', { x: LEFT - 8, y: y(value) + 5, class: 'end' }, number(value)));
  }
  for (const i of ticks(0, n - 1, 10)) {
    svg.append(draw('text', { x: x(i), y: HEIGHT - BOTTOM + 20, class: 'middle' }, number(first + i)));
  }
  svg.append(draw('text', { x: (LEFT + WIDTH) / 2, y: HEIGHT - 3, class: 'middle' }, t('history.session')),
    draw('text', { x: -(TOP + HEIGHT - BOTTOM) / 2, y: 13, class: 'middle up' }, t('history.questions')),
    draw('polyline', { class: 'line',
      points: recent.map((each, i) => `${x(i).toFixed(1)},${y(each.questions).toFixed(1)}`).join(' ') }));
  recent.forEach((each, i) => {
    svg.append(draw('circle', { cx: x(i).toFixed(1), cy: y(each.questions).toFixed(1), r: n > 60 ? 3 : 5,
      class: 'dot' }));
  });
  return svg;
}

function table(recent, first) {
  const head = ['history.session', 'history.when', 'history.task', 'history.questions'];
  const rows = recent.map((each, i) => make('tr', {},
    make('th', { scope: 'row' }, number(first + i)),
    make('td', {}, date(each.utime)),
    make('td', {}, pair(each, each.instance > 1)),
    make('td', {}, number(each.questions))));
  return make('div', { class: 'scrolls', tabindex: '0', role: 'region', 'aria-label': t('history.table') },
    make('table', {},
      make('thead', {}, make('tr', {}, ...head.map((key) => make('th', { scope: 'col' }, t(key))))),
      make('tbody', {}, ...rows.reverse())));
}
