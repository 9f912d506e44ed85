// SPDX-License-Identifier: GPL-3.0-or-later
// Debian's Firefox for the end-to-end tests, by WebDriver BiDi. Without a window it has no WebGL 2, so it gets a
// screen in memory, on which Mesa draws by software. It has no sound device. Exit status 77: one of these programs is
// not here, skipped.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync } from 'node:fs';
import playwright from 'playwright-core';

const firefox = process.env.FIREFOX ?? '/usr/bin/firefox-esr';
const screen = '/usr/bin/Xvfb';

/** A screen in memory: its process, and its name for DISPLAY. */
async function openScreen() {
  const words = ['-displayfd', '3', '-screen', '0', '1920x1200x24', '-nolisten', 'tcp'];
  const child = spawn(screen, words, { stdio: ['ignore', 'ignore', 'ignore', 'pipe'] });
  const [said] = await Promise.race([
    once(child.stdio[3], 'data'),
    once(child, 'exit').then(([status]) => assert.fail(`${screen} ended with ${status}`)),
  ]);
  return { child, display: `:${String(said).trim()}` };
}

export async function launchFirefox() {
  const lacks = [firefox, screen].filter((program) => !existsSync(program));
  if (lacks.length > 0) {
    console.log(`skipped: no ${lacks.join(', ')}`);
    process.exit(77);
  }
  const { child, display } = await openScreen();
  const end = () => child.kill();
  process.once('exit', end);
  // This way to Firefox has no public name yet. The public one asks for a Firefox that only Playwright builds.
  const browser = await playwright._bidiFirefox.launch({
    executablePath: firefox,
    headless: false,
    env: { ...process.env, DISPLAY: display, MOZ_ENABLE_WAYLAND: '0', LIBGL_ALWAYS_SOFTWARE: '1' },
    timeout: 120_000,
  });
  browser.once('disconnected', end);
  return browser;
}
