// The real programs on the private bus of this network namespace (see run): capture with the
// embedded scene, perception, pose, intention and ui_bridge with the page. A test kills and
// restarts what it likes.

import { execFileSync, spawn } from 'node:child_process';
import fs from 'node:fs';
import net from 'node:net';
import os from 'node:os';
import path from 'node:path';

export const SOURCE = process.env.BECKON_SOURCE;  // set by run
const BUILD = process.env.BECKON_BUILD;
const FOLDERS = [path.join(BUILD, 'bin'), ...(process.env.BECKON_BIN ?? '').split(':').filter(Boolean)];
const LCM_URL = 'udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2097152';

/** Which embedded scene; this one has a carton, a cup and a bottle among its objects. */
export const SEED = 11;

export function program(name) {
  const found = FOLDERS.map((folder) => path.join(folder, name)).find((file) => fs.existsSync(file));
  if (!found) throw new Error(`${name}: not in ${FOLDERS.join(' nor ')}; build it, or name its folder in BECKON_BIN`);
  return found;
}

export async function until(condition, what, timeoutMs = 15000) {
  const end = performance.now() + timeoutMs;
  for (;;) {
    const value = await condition();
    if (value) return value;
    if (performance.now() > end) throw new Error(`waited ${timeoutMs / 1000} s for ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 25));
  }
}

function freePort() {
  return new Promise((resolve) => {
    const server = net.createServer().listen(0, '127.0.0.1', () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

export class System {
  static async start({ user = 'ann' } = {}) {
    const system = new System();
    system.user = user;
    system.folder = fs.mkdtempSync(path.join(os.tmpdir(), 'beckon-browser-'));
    system.port = await freePort();
    system.url = `http://127.0.0.1:${system.port}/`;
    system.processes = new Map();
    process.on('exit', () => system.processes.forEach((child) => child.kill('SIGKILL')));
    try {
      for (const name of ['perception', 'pose', 'intention', 'capture', 'ui_bridge']) system.launch(name);
      await system.ready();
    } catch (error) {
      const logs = [...system.processes.keys()].map((name) => `${name}: ${system.log(name).trim().split('\n').pop()}`);
      await system.stop();
      throw new Error(`${error.message}\n${logs.join('\n')}`);
    }
    return system;
  }

  commandLine(name) {
    return {
      capture: ['beckon-capture', '--embedded-seed', String(SEED)],
      perception: ['beckon-perception'],
      pose: ['beckon-pose'],
      intention: ['beckon-intention', '--db', path.join(this.folder, 'beckon.db')],
      ui_bridge: ['beckon-ui-bridge', '--front-end', 'web', '--port', String(this.port), '--user', this.user],
    }[name];
  }

  /** Starts a program; it runs until kill() or stop(). */
  launch(name) {
    const [file, ...args] = this.commandLine(name);
    const log = fs.openSync(path.join(this.folder, `${name}.log`), 'a');
    const env = { ...process.env, XDG_DATA_HOME: this.folder, XDG_STATE_HOME: this.folder };
    const child = spawn(program(file), [...args, '--lcm-url', LCM_URL], { stdio: ['ignore', log, log], env });
    child.ended = new Promise((resolve) => child.on('exit', resolve));
    fs.closeSync(log);
    this.processes.set(name, child);
  }

  async kill(name) {
    const child = this.processes.get(name);
    child.kill('SIGKILL');
    await child.ended;
    this.processes.delete(name);
  }

  async restart(name) {
    await this.kill(name);
    this.launch(name);
  }

  async stop() {
    if (process.env.BECKON_KEEP_LOGS) fs.cpSync(this.folder, process.env.BECKON_KEEP_LOGS, { recursive: true });
    await Promise.all([...this.processes.keys()].map((name) => this.kill(name)));
    fs.rmSync(this.folder, { recursive: true, force: true });
  }

  /** The page is served and something is seen on the table. */
  async ready() {
    await until(() => this.state().then(() => true, () => false), 'the page to be served');
    // Whoever opens a stream makes the camera's images flow.
    const open = new AbortController();
    await fetch(`${this.url}api/events?view=partner`, { signal: open.signal });
    await until(async () => (await this.state()).scene?.objects.length > 0, 'objects to be seen', 30000);
    open.abort();
  }

  async get(what) {
    const response = await fetch(this.url + what);
    if (!response.ok) throw new Error(`${what}: HTTP ${response.status}`);
    return response.json();
  }
  state() {
    return this.get('api/state');
  }

  async send(method, what, body) {
    const response = await fetch(this.url + what, { method, body: JSON.stringify(body),
      headers: { 'Content-Type': 'application/json' } });
    return { status: response.status, body: await response.json() };
  }

  /** What really stands on the table, with the pixels of its middle. */
  truth() {
    if (this.objects) return this.objects;
    const file = path.join(this.folder, 'truth.json');
    execFileSync(program('beckon-capture'), ['--embedded-seed', String(SEED), '--truth', file], { stdio: 'ignore' });
    const { objects, intrinsics: k } = JSON.parse(fs.readFileSync(file));
    this.objects = objects.map(({ category, centroid_C: [x, y, z] }) => ({
      category, u: (k.fx * x) / z + k.cx, v: (k.fy * y) / z + k.cy }));
    return this.objects;
  }

  log(name) {
    return fs.readFileSync(path.join(this.folder, `${name}.log`), 'utf8');
  }
}
