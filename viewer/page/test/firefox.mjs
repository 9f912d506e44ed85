// SPDX-License-Identifier: GPL-3.0-or-later
// Debian's Firefox for the end-to-end tests, by WebDriver BiDi. Without a window it has no WebGL 2, so it gets a
// screen in memory, on which Mesa draws by software. Without a sound device its audio does not run, so it gets one that
// nobody hears. Exit status 77: one of these programs is not here, skipped.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import playwright from 'playwright-core';

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

/** A sound server with one device, which nobody hears: its process, its folder, and its address for PULSE_SERVER. */
async function openSound() {
  const folder = mkdtempSync(join(tmpdir(), 'insula_pulse_'));
  const socket = join(folder, 'native');
  const lone = ['-n', '--daemonize=no', '--use-pid-file=no', '--exit-idle-time=-1', '--disable-shm=yes'];
  const modules = ['module-null-sink rate=48000', `module-native-protocol-unix socket=${socket}`];
  const child = spawn(soundServer, [...lone, ...modules.flatMap((m) => ['-L', m])], {
    env: { ...process.env, XDG_RUNTIME_DIR: folder },
    stdio: 'ignore',
  });
  child.once('exit', () => rmSync(folder, { recursive: true, force: true }));
  for (let k = 0; k < 200 && !existsSync(socket) && child.exitCode === null; k++) await sleep(50);
  assert.ok(existsSync(socket), `${soundServer} runs`);
  return { child, server: `unix:${socket}` };
}

export async function launchFirefox() {
  const lacks = [firefox, screen, soundServer].filter((program) => !existsSync(program));
  if (lacks.length > 0) {
    console.log(`skipped: no ${lacks.join(', ')}`);
    process.exit(77);
  }
  const [{ child, display }, sound] = [await openScreen(), await openSound()];
  const end = () => [child, sound.child].forEach((c) => c.kill());
  process.once('exit', end);
  // This way to Firefox has no public name yet. The public one asks for a Firefox that only Playwright builds.
  const browser = await playwright._bidiFirefox.launch({
    executablePath: firefox,
    headless: false,
    env: {
      ...process.env,
      DISPLAY: display,
      PULSE_SERVER: sound.server,
      MOZ_ENABLE_WAYLAND: '0',
      LIBGL_ALWAYS_SOFTWARE: '1',
    },
    timeout: 120_000,
  });
  browser.once('disconnected', end);
  return browser;
}
