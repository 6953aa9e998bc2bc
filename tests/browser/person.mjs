// Somebody who wants one thing, looks at the table and at the page, and answers truly. What a
// question means is read from /api/state; every answer goes through the page.

import { button } from './browser.mjs';
import { until } from './system.mjs';

/** Whether the proposition holds for the task that is wanted. */
function holds(option, want, nameOf) {
  const actions = !option.actions?.length || option.actions.includes(want.action);
  const objects = !option.objects?.length || option.objects.some((id) => nameOf(id) === want.category);
  return actions && objects;
}

export class Person {
  constructor(system, page, want) {
    this.system = system;
    this.page = page;
    this.want = want;
    this.questions = 0;
    this.seen = new Set();
  }

  /** What an object is, seen with the eyes: the nearest one of the ground truth. */
  nameOf(state, id) {
    const object = state.scene.objects.find((each) => each.id === id);
    if (!object) return null;
    const mean = (i) => object.outline_px.reduce((sum, p) => sum + p[i], 0) / object.outline_px.length;
    const [u, v] = [mean(0), mean(1)];
    const far = ({ u: x, v: y }) => Math.hypot(x - u, y - v);
    return this.system.truth().reduce((best, each) => (far(each) < far(best) ? each : best)).category;
  }

  /** Index of the true option. */
  decide(state) {
    const { query } = state;
    const nameOf = (id) => this.nameOf(state, id);
    if (query.kind === 'what_is_it') {
      const id = query.about?.[0]?.object_id ?? query.yes_if.objects[0].object_id;
      const index = query.options.findIndex((option) => option.category === nameOf(id));
      return index >= 0 ? index : query.options.length - 1;
    }
    if (query.kind === 'choice') {
      return query.options.findIndex((option, i) => i === query.options.length - 1 || holds(option, this.want, nameOf));
    }
    const { actions, objects } = query.yes_if;
    const isYes = holds({ actions, objects: objects?.map((each) => each.object_id) }, this.want, nameOf);
    return isYes ? 0 : 1;
  }

  /** The question that stands on the page and is not answered, with its state. */
  async nextQuestion() {
    return until(async () => {
      const state = await this.system.state();
      if (state.event.kind === 'confirmed' || state.event.kind === 'abandoned') return { over: state };
      if (!state.query || !state.scene || state.query.answered || this.seen.has(state.query.id)) return null;
      return (await this.isShown(state.query)) ? state : null;
    }, `a question after ${this.questions} answers`, 20000).catch(async (error) => {
      const { query, phase, event, notice } = await this.system.state();
      throw new Error(`${error.message}; ${JSON.stringify({ query: query?.text, answered: query?.answered, phase, event, notice })}`);
    });
  }

  /** On the page, and presses count. */
  async isShown(query) {
    return this.page.evaluate(([id, text]) => document.getElementById('question').textContent === text &&
      document.querySelector(`#options[data-query="${id}"] button[aria-disabled=false]`) !== null, [query.id, query.text]);
  }

  /** Answers until the session is over; the last state. `act(index, state)` says an answer. */
  async converse(act) {
    await until(async () => (await this.system.state()).phase === 'running', 'the session to begin');
    for (;;) {
      const state = await this.nextQuestion();
      if (state.over) return state.over;
      this.seen.add(state.query.id);
      this.questions += 1;
      try {
        await act(this.decide(state), state);
      } catch (error) {
        // Another question took its place: then that one is answered.
        if ((await this.system.state()).query?.id === state.query.id) throw error;
        this.questions -= 1;
      }
    }
  }

  /** A new session where the last one is over. */
  async begin(press) {
    await until(async () => {
      const { phase, query } = await this.system.state();
      if (phase === 'running' || query) return true;
      await press(button(this.page, 'New task')).catch(() => {});  // it may be joining one that runs
      return false;
    }, 'a session');
  }
}

/** The button of an answer to this very question. */
const answer = (page, index, state) => page.locator(`#options[data-query="${state.query.id}"] button`).nth(index);

export const byMouse = (page) => async (index, state) => {
  await answer(page, index, state).click({ timeout: 5000 });
};

/** Tab and Enter alone. */
export const byKeyboard = (page) => async (index, state) => {
  await tabTo(page, answer(page, index, state));
  await page.keyboard.press('Enter');
};

/** Tabs until the focus is on `target`; fails where it is not reached. */
export async function tabTo(page, target, most = 60) {
  for (let i = 0; i < most; ++i) {
    if (await target.evaluate((element) => element === document.activeElement, null, { timeout: 5000 })) return i;
    await page.keyboard.press('Tab');
  }
  throw new Error('not reached by Tab');
}

/** The space bar alone: pressed while what is wanted is lit. */
export const byOneKey = (page) => async (index, state) => {
  const id = state.query.id;
  for (let press = 0; press < 12; ++press) {
    const isLit = (i) => document.querySelectorAll('#options > *')[i]?.classList.contains('lit');
    await page.waitForFunction(isLit, index, { timeout: 30000, polling: 20 });
    await page.keyboard.down(' ');
    await page.keyboard.up(' ');
    const isTaken = await page.waitForFunction(([text, i]) => {
      const button = document.querySelectorAll('#options > *')[i];
      return document.getElementById('question').textContent !== text ||
        button?.getAttribute('aria-disabled') === 'true';
    }, [state.query.text, index], { timeout: 700, polling: 20 }).then(() => true, () => false);
    if (isTaken) return;
  }
  throw new Error(`question ${id} was not answered by the switch`);
};
