// Chromium, and pages in it that are watched: no request to another host, no error in the console.

import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { chromium } from 'playwright-core';

const ARGS = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage', '--lang=en-US'];

export class Browser {
  static async start() {
    const browser = new Browser();
    browser.home = fs.mkdtempSync(path.join(os.tmpdir(), 'beckon-chromium-'));
    browser.chromium = await chromium.launch({
      executablePath: process.env.BECKON_CHROMIUM ?? '/usr/bin/chromium', args: ARGS,
      env: { ...process.env, HOME: browser.home, XDG_CONFIG_HOME: browser.home, XDG_CACHE_HOME: browser.home } });
    browser.problems = [];
    return browser;
  }

  async stop() {
    await this.chromium.close();
    fs.rmSync(this.home, { recursive: true, force: true });
  }

  /** A page in a window of its own, opened at `url`. `quiet`: it may lose its connection. */
  async open(url, { size = [1280, 800], quiet = false, ...options } = {}) {
    const context = await this.chromium.newContext({
      viewport: { width: size[0], height: size[1] }, locale: 'en-US', reducedMotion: 'no-preference', ...options });
    const page = await context.newPage();
    page.quiet = quiet;
    this.watch(page);
    await page.goto(url, { waitUntil: 'commit' });
    return page;
  }

  watch(page) {
    const problem = (text) => {
      if (!this.problems.includes(text)) this.problems.push(text);
    };
    page.on('console', (message) => {
      const isLost = /ERR_|Failed to load resource/.test(message.text()) && page.quiet;
      if (['error', 'warning'].includes(message.type()) && !isLost) problem(`console: ${message.text()}`);
    });
    page.on('pageerror', (error) => problem(`exception: ${error.stack}`));
    page.on('request', (request) => {
      const url = new URL(request.url());
      // The test's own programs are all that is to be asked.
      const isOurs = url.protocol === 'http:' && url.hostname === '127.0.0.1';
      if (!isOurs && !['data:', 'blob:', 'about:'].includes(url.protocol)) problem(`request to ${request.url()}`);
    });
  }
}

/** Waits until `check` (run in the page) holds. */
export const whenPage = (page, check, argument, timeout = 15000) =>
  page.waitForFunction(check, argument, { timeout, polling: 50 });

export const button = (page, name) => page.getByRole('button', { name, exact: true });
export const heading = (page) => page.locator('main h1:visible').first();
