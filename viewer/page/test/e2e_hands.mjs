// SPDX-License-Identifier: GPL-3.0-or-later
// A person with human errors practises an exercise through the real page, engine and haptic server, once for each
// seed: node test/e2e_hands.mjs [SCENE] [--seeds 10] [--programs FOLDER] [--port 8090] [--minutes 9]. It tells which
// seeds reached all goals, and fails when fewer than eight of ten did. Exit status 77: no browser or no programs.
import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { patience } from './browser.mjs';
import { pause, Person } from './human_hands.mjs';
import { Practice } from './human_practice.mjs';
import { launchUndrawn, openUndrawn } from './undrawn.mjs';

const root = fileURLToPath(new URL('../../..', import.meta.url));
const option = (name, otherwise) => {
  const i = process.argv.indexOf(`--${name}`);
  return i < 0 ? otherwise : process.argv[i + 1];
};
const scene = process.argv[2]?.endsWith('.xml') ? process.argv[2] : join(root, 'scenes/training/1_sylvian_fissure.xml');
const programs = option('programs', join(root, 'build/release/bin'));
const seeds = Number(option('seeds', '10'));
const first = Number(option('from', '1'));
const port = Number(option('port', '8090'));
const minutes = Number(option('minutes', '9'));
if (!existsSync(join(programs, 'gateway'))) {
  console.log(`skipped: no programs in ${programs}`);
  process.exit(77);
}

/** Engine, haptic server and gateway, the last one with the page that was built here. */
function startSession() {
  const own = { LCM_DEFAULT_URL: 'udpm://239.255.76.67:7719?ttl=0', ...process.env };
  const run = (program, ...rest) => spawn(join(programs, program), rest, { env: own, stdio: 'ignore' });
  const still = ['--no-browser', '--no-report', '--no-record', '--no-reload'];
  const play = ['play', scene, '--motion', 'none', '--mode', 'practice', ...still];
  const session = run('insula', ...play, '--port', String(port));
  const page = [
    '--page',
    fileURLToPath(new URL('../dist', import.meta.url)),
    '--port',
    String(port + 1),
    '--exact-port',
  ];
  return [session, run('gateway', ...page)];
}

async function end(programsRunning) {
  const gone = programsRunning.map((p) => new Promise((r) => (p.exitCode !== null ? r() : p.once('exit', r))));
  for (const p of programsRunning) p.kill('SIGINT');
  await Promise.all(gone);
}

let passed = 0;
for (let seed = first; seed < first + seeds; seed++) {
  const running = startSession();
  const browser = await launchUndrawn();
  try {
    const page = await openUndrawn(browser, { width: 1280, height: 800 });
    page.on('framenavigated', (f) => console.log(`   the browser shows ${f.url()}`));
    const url = `http://127.0.0.1:${port + 1}/?quality=draft`;
    for (let k = 0; k < 60 && !(await page.goto(url).catch(() => null)); k++) await pause(500);
    if (running.some((p) => p.exitCode !== null)) throw new Error(`port ${port} or ${port + 1} is taken`);
    await page.waitForFunction(() => window.__insula?.ready, null, patience);
    for (const button of await page.locator('.toast button').all()) await button.click({ timeout: 60_000 });
    const started = Date.now();
    const view = await new Practice(new Person(page, seed)).until(Date.now() + 60_000 * minutes);
    const reached = view.goals.length > 0 && view.goals.every((g) => g.done);
    if (reached) passed++;
    const goals = view.goals.map((g) => `${g.done ? 'reached' : 'not reached'}: ${g.text}`);
    const seconds = ((Date.now() - started) / 1000).toFixed(0);
    const end = view.end || 'not at the end';
    console.log(
      `${reached ? 'ok ' : 'no '} seed ${seed}, ${seconds} s, ${end}: ${[...goals, ...view.faults].join('; ')}`,
    );
  } finally {
    await browser.close();
    await end(running);
  }
}
console.log(`${passed} of ${seeds} seeds reached all goals`);
process.exit(passed >= 0.8 * seeds ? 0 : 1);
