// Dwelling: a pointer that rests on a button clicks it, for gaze and head mice. After a click, and
// after a new question, it has to leave the button before it can click again.

const TARGETS = 'button, summary, label, a[href], input';

export class Dwell {
  constructor() {
    this.seconds = 0;
    this.target = null;
    this.spent = null;  // clicked, and not left since
    document.addEventListener('pointerover', (event) => this.enter(event));
    document.documentElement.addEventListener('pointerleave', () => this.leave());
    document.addEventListener('pointerdown', () => this.spend());
  }

  /** 0: off. */
  set(seconds) {
    this.seconds = seconds;
    if (seconds === 0) this.leave();
  }

  /** What the pointer rests on now is another thing than a moment ago. */
  spend() {
    const target = this.target ?? this.spent;
    this.leave();
    this.spent = target;
  }

  enter({ target, pointerType }) {
    if (this.seconds === 0 || pointerType === 'touch') return;
    const next = target.closest?.(TARGETS) ?? null;
    if (next === this.target) return;
    if (next !== this.spent || next === null) this.spent = next === null ? null : this.spent;
    if (next !== null && next === this.spent) return;
    this.leave();
    if (next !== null) this.rest(next);
  }

  rest(target) {
    this.spent = null;
    this.target = target;
    target.style.setProperty('--dwell', `${this.seconds}s`);
    target.classList.add('dwelling');
    this.timer = setTimeout(() => {
      this.spend();
      target.click();
    }, 1000 * this.seconds);
  }

  leave() {
    clearTimeout(this.timer);
    this.target?.classList.remove('dwelling');
    this.target = null;
  }
}
