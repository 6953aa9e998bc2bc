// While the page is scanned, space and Enter are its switches: they go to the server as they go
// down and up, and click nothing here. The server's scanner decides what they mean.

import { byId } from './dom.js';
import { post } from './server.js';

const TEXT = 'input[type=text], input:not([type]), textarea';

export class Switches {
  constructor() {
    this.on = false;
    this.two = false;
    this.held = new Set();
    this.queue = Promise.resolve();
    document.addEventListener('keydown', (event) => this.onKey(event, true), true);
    document.addEventListener('keyup', (event) => this.onKey(event, false), true);
    window.addEventListener('blur', () => this.releaseAll());
    document.addEventListener('visibilitychange', () => this.releaseAll());
    this.pad = byId('pad');
    this.pad.addEventListener('pointerdown', (event) => {
      this.pad.setPointerCapture(event.pointerId);
      this.press(0, true);
    });
    for (const end of ['pointerup', 'pointercancel']) {
      this.pad.addEventListener(end, () => this.press(0, false));
    }
  }

  /** `scanning`: by the page's own scanner; `two`: Enter is the second switch. */
  set(scanning, two) {
    if (this.on && !scanning) this.releaseAll();
    this.on = scanning;
    this.two = two;
    this.pad.hidden = !scanning;
  }

  switchOf(event) {
    if (event.code === 'Space' || event.key === ' ') return 0;
    if (event.key === 'Enter') return this.two ? 1 : 0;
    return null;
  }

  onKey(event, down) {
    const which = this.switchOf(event);
    if (!this.on || which === null || event.target.matches?.(TEXT)) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    if (!event.repeat) this.press(which, down);
  }

  /** One after the other, so that no release overtakes its press. */
  press(which, down) {
    if (this.held.has(which) === down) return;
    if (down) this.held.add(which);
    else this.held.delete(which);
    this.queue = this.queue.then(() => post('/api/press', { switch: which, down }));
  }

  releaseAll() {
    for (const which of [...this.held]) this.press(which, false);
  }
}
