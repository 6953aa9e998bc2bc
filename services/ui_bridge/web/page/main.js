// Starts the page: opens the stream of states and gives each to the parts.

import { applyAppearance } from './appearance.js';
import { byId, make, setText } from './dom.js';
import { Dwell } from './dwell.js';
import { History } from './history.js';
import { t } from './i18n.js';
import { Switches } from './keys.js';
import { Picture } from './picture.js';
import { Question } from './question.js';
import { get } from './server.js';
import { Settings } from './settings.js';
import { showStatus, Stop } from './stop.js';
import { StateStream } from './stream.js';
import { Trial } from './trial.js';
import { User } from './user.js';
import { Why } from './why.js';

const MESSAGE_MS = 15000;

const partner = new URLSearchParams(location.search).get('view') === 'partner';
const app = { state: null, connected: false, view: 'question', settings: null, profile: null };
const parts = {};

/** A line for the user; it stays until the next, or for some seconds. */
function tell(text) {
  const line = byId('message');
  line.textContent = text;
  clearTimeout(tell.timer);
  tell.timer = setTimeout(() => (line.textContent = ''), MESSAGE_MS);
}

function showView(name, { focus = false } = {}) {
  const isStopped = Boolean(app.state?.stopped || app.state?.stopping);
  const shown = isStopped ? 'stopped' : name;
  app.view = name;
  const isNew = app.shownView !== shown;
  app.shownView = shown;
  for (const section of document.querySelectorAll('main > section')) {
    const id = section.id.replace('view-', '');
    section.hidden = id !== shown && !(partner && !isStopped && id === 'history');
  }
  for (const button of byId('nav').children) {
    button.setAttribute('aria-pressed', String(button.dataset.view === name));
  }
  if (isNew && (focus || shown === 'stopped')) byId('scroll').scrollTop = 0;
  if (isNew && focus) byId(`view-${shown}`).querySelector('h1')?.focus();
}

async function loadSettings() {
  const reply = await get('/api/settings');
  if (reply.ok && reply.body.settings) {
    app.settings = reply.body;
    await useSettings(reply.body.settings);
    parts.settings?.update(reply.body);
    parts.trial?.settled(reply.body);
  }
  render();
}

async function useSettings(settings) {
  await applyAppearance(partner ? { language: settings.language } : settings);
  document.body.classList.toggle('partner', partner);
  parts.picture.show = partner ? { picture: true, shapes: true } : settings.show ?? parts.picture.show;
  parts.dwell.set(partner ? 0 : settings.dwell_s ?? 0);
}

async function loadProfile() {
  const reply = await get('/api/profile');
  if (!reply.ok) return;
  app.profile = reply.body;
  parts.history.update(app.profile);
  parts.user?.update(app.profile, app.state.user);
}

function onState(state) {
  const before = app.state;
  app.state = state;
  if (before?.query?.id !== state.query?.id) parts.dwell.spend();
  if (before?.settings_rev !== state.settings_rev || !app.settings) loadSettings();
  if (before?.profile_rev !== state.profile_rev || before?.user !== state.user) loadProfile();
  if (state.notice && state.notice !== before?.notice) tell(state.notice);
  render();
}

function render() {
  const { state, connected } = app;
  showStatus({ connected, state });
  document.body.classList.toggle('offline', !connected);
  if (!state) return;
  const wasStopped = app.shownView === 'stopped';
  const isStopped = Boolean(state.stopped || state.stopping);
  parts.stop.update(state, partner);
  showView(app.view, { focus: wasStopped !== isStopped });
  parts.question.update(state, connected);
  parts.picture.update(state);
  parts.why.update(state);
  if (partner) return;
  parts.trial.update(state);
  parts.user.update(app.profile, state.user);
  parts.switches.set(state.scanning && connected, app.settings?.settings.access === 'two_switches');
  document.title = state.query ? `${state.query.text} – Beckon` : 'Beckon';
}

function onConnection(connected) {
  app.connected = connected;
  setText(byId('offline'), connected ? '' : t('offline'));
  render();
}

function makeParts() {
  parts.question = new Question({ partner, tell });
  parts.picture = new Picture();
  parts.why = new Why({ partner });
  parts.history = new History();
  parts.dwell = new Dwell();
  if (partner) {
    byId('partner').hidden = false;
    byId('nav').hidden = true;
    byId('scroll').tabIndex = 0;  // there is nothing else to scroll by
    return;
  }
  parts.switches = new Switches();
  parts.trial = new Trial({ tell });
  parts.settings = new Settings();
  parts.user = new User({ tell, done: () => showView('question', { focus: true }) });
}

async function start() {
  parts.stop = new Stop({ tell });  // works before anything else does
  await applyAppearance({}).catch(() => {});
  makeParts();
  for (const button of byId('nav').children) {
    button.addEventListener('click', () => showView(button.dataset.view, { focus: true }));
  }
  const view = partner ? 'partner' : 'user';
  const page = crypto.randomUUID?.() ?? String(Math.random()).slice(2);
  const path = (again) => `/api/events?view=${view}&page=${page}${again ? '&again=1' : ''}`;
  new StateStream(path, { onState, onConnection }).run();
}

start();
