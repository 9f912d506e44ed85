// SPDX-License-Identifier: GPL-3.0-or-later
// Debian's Firefox for the end-to-end tests, by WebDriver BiDi. Without a window it has no WebGL 2, so it gets a
// screen in memory, on which Mesa draws by software; its sound goes to a device that nobody hears. Exit status 77: one
// of these programs is not here, skipped.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import playwright from 'playwright-core';
import { waitFor } from './patience.mjs';

const firefox = process.env.FIREFOX ?? '/usr/bin/firefox-esr';
const screen = '/usr/bin/Xvfb';
const soundServer = '/usr/bin/pulseaudio';

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

/** A sound device that drops what it is given: its process, and where programs find it. It listens already. */
async function openSound(folder) {
  const socket = join(folder, 'sound');
  const modules = ['module-null-sink', `module-native-protocol-unix auth-anonymous=1 socket=${socket}`];
  const words = ['-n', '--daemonize=no', '--exit-idle-time=-1', '--use-pid-file=no', '--disable-shm=yes'];
  const own = { PULSE_RUNTIME_PATH: folder, PULSE_STATE_PATH: folder, PULSE_COOKIE: join(folder, 'cookie') };
  const child = spawn(soundServer, [...words, ...modules.flatMap((m) => ['-L', m])], {
    env: { ...process.env, ...own },
    stdio: 'ignore',
  });
  // A browser that finds no device at its start does not look again.
  await waitFor('sound device', () => existsSync(socket));
  return { child, env: { ...own, PULSE_SERVER: `unix:${socket}` } };
}

export async function launchFirefox() {
  const lacks = [firefox, screen, soundServer].filter((program) => !existsSync(program));
  if (lacks.length > 0) {
    console.log(`skipped: no ${lacks.join(', ')}`);
    process.exit(77);
  }
  const folder = mkdtempSync(join(tmpdir(), 'insula_firefox_'));
  const sound = await openSound(folder);
  const { child, display } = await openScreen();
  const end = () => {
    for (const each of [sound.child, child]) each.kill();
    rmSync(folder, { recursive: true, force: true });
  };
  process.once('exit', end);
  // This way to Firefox has no public name yet. The public one asks for a Firefox that only Playwright builds.
  const browser = await playwright._bidiFirefox.launch({
    executablePath: firefox,
    headless: false,
    env: { ...process.env, ...sound.env, DISPLAY: display, MOZ_ENABLE_WAYLAND: '0', LIBGL_ALWAYS_SOFTWARE: '1' },
    timeout: 120_000,
  });
  browser.once('disconnected', end);
  return browser;
}
