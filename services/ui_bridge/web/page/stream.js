// The server's stream of states, read by fetch, which hears the heartbeats that EventSource hides:
// silence means "not connected", and is said. Goes on trying for ever.

const SILENCE_MS = 6000;   // the server's heart beats every 2 s
const RETRY_MS = [250, 500, 1000, 2000];

/** Gives each event of an event stream's text, in pieces of any size, to `onEvent(name, data)`. */
export function makeEventParser(onEvent) {
  let rest = '';
  let name = 'message';
  let data = [];
  const line = (text) => {
    if (text === '') {
      if (data.length > 0) onEvent(name, data.join('\n'));
      name = 'message';
      data = [];
    } else if (!text.startsWith(':')) {
      const [, field, value] = /^([^:]*):? ?(.*)$/s.exec(text);
      if (field === 'event') name = value;
      if (field === 'data') data.push(value);
    }
  };
  return (text) => {
    const lines = (rest + text).split(/\r\n|\n/);
    rest = lines.pop();
    lines.forEach(line);
  };
}

export class StateStream {
  /** `path`: of the first connection and of later ones; `onState(state)`,
   * `onConnection(connected)`: when it changes. */
  constructor(path, { onState, onConnection }) {
    this.path = path;
    this.onState = onState;
    this.onConnection = onConnection;
    this.connected = false;
    this.failures = 0;
    this.everConnected = false;
  }

  async run() {
    for (;;) {
      await this.connectOnce().catch(() => {});
      this.say(false);
      const wait = RETRY_MS[Math.min(this.failures++, RETRY_MS.length - 1)];
      await new Promise((resolve) => setTimeout(resolve, wait));
    }
  }

  say(connected) {
    if (connected === this.connected && this.everConnected) return;
    this.connected = connected;
    this.onConnection(connected);
  }

  async connectOnce() {
    const abort = new AbortController();
    let silence = setTimeout(() => abort.abort(), SILENCE_MS);
    const heard = () => {
      clearTimeout(silence);
      silence = setTimeout(() => abort.abort(), SILENCE_MS);
    };
    try {
      const response = await fetch(this.path(this.everConnected), {
        signal: abort.signal, cache: 'no-store', headers: { Accept: 'text/event-stream' } });
      if (!response.ok) throw new Error(`HTTP ${response.status}`);
      const parse = makeEventParser((name, data) => {
        if (name !== 'state') return;
        this.failures = 0;
        this.say(true);
        this.everConnected = true;
        const state = JSON.parse(data);
        queueMicrotask(() => this.onState(state));  // what goes wrong there is no loss of connection
      });
      const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
      for (;;) {
        const { done, value } = await reader.read();
        if (done) return;
        heard();
        parse(value);
      }
    } finally {
      clearTimeout(silence);
      abort.abort();
    }
  }
}
