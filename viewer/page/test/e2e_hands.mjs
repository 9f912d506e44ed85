// SPDX-License-Identifier: GPL-3.0-or-later
// A person with human errors practises an exercise through the real page, engine and haptic server, once for each
// seed: node test/e2e_hands.mjs [SCENE] [--seeds 10] [--programs FOLDER] [--port 8090] [--minutes 9]. It tells which
// seeds reached all goals, and fails when fewer than eight of ten did. Exit status 77: no browser or no programs.
import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { launch, patience } from './browser.mjs';
import { pause, Person } from './human_hands.mjs';

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
  const play = ['play', scene, '--no-browser', '--motion', 'none', '--mode', 'practice', '--no-report', '--no-reload'];
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

/** What the hand does at a target that is reached but for its buttons. */
async function press(person, view) {
  for (const [, on, off] of view.todo.matchAll(/hold button (\d)|let button (\d) go/g)) {
    // A goal may ask to hold on for a while.
    if (off === '1') await pause(3000);
    await person.squeeze(Number(on ?? off), Boolean(on));
    // Blades take their time.
    if (off) await pause(1000);
  }
}

/** Practises until all goals are reached or the time is over. */
async function practise(person, until) {
  const { page } = person;
  /** Of each hand: how many targets it has, and whether it has done them. */
  const course = [0, 1].map(() => ({ of: 0, done: false }));
  let turnedFor = '';
  let tries = 0;
  let view = await person.look();
  while (Date.now() < until && view.end === '') {
    const { target } = view;
    const here = `${view.hand} ${target?.at}`;
    if (target === null || view.otherFirst) {
      await person.holdHere();
      view = await person.look();
      continue;
    }
    const mine = course[view.hand];
    const other = course[1 - view.hand];
    mine.of = target.of;
    mine.done ||= target.at === target.of && target.near;
    // All targets are done, but not all goals: the hand that has more of them begins again.
    if (mine.done && (!other.done || other.of > mine.of)) {
      await person.holdHere();
      view = await person.settled();
      continue;
    }
    if (mine.done) {
      mine.done = false;
      for (let k = 3; k < target.of; k++) await page.keyboard.press('Shift+N');
      view = await person.settled();
      continue;
    }
    const choice = /^Choose from the list: (.*) \(L\)$/.exec(view.todo)?.[1];
    if (choice) {
      await person.choose(choice);
      view = await person.settled();
      continue;
    }
    if (here !== turnedFor) tries = 0;
    if (!target.near && target.degrees > 5 && (here !== turnedFor || tries > 2)) {
      await page.keyboard.press('y');
      await person.settled();
      if (tries === 0) await person.tremble();
    }
    turnedFor = here;
    tries++;
    view = await person.look();
    if (view.target?.at !== target.at || view.hand < 0) continue;
    if (view.target.near && /button/.test(view.todo)) {
      await press(person, view);
      view = await person.settled();
      continue;
    }
    if (tries > 12) await page.keyboard.press('n');
    view = await person.reach(view);
    if (tries === 1 || process.env.VERBOSE) tell(view, person);
  }
  return view;
}

function tell({ hand, target, goals, faults }, person) {
  const seconds = ((Date.now() - person.began) / 1000).toFixed(0);
  const done = goals.map((g) => (g.done ? '+' : '-')).join('');
  const at = target ? `${target.at}/${target.of}, ${target.mm} mm, ${target.degrees} degrees` : 'no target';
  const scale = `${(1e6 * person.mPerPx).toFixed(0)} um a pixel`;
  console.log(`   ${seconds} s: hand ${hand}: ${at}; goals ${done}; ${faults.join('; ')}; ${scale}`);
}

/**
 * Runs in the page. The person reads the panels and never the field, so it is not drawn: here is no graphics card, and
 * one that draws would take none of the processor's time either.
 */
function drawNothing() {
  for (const name of ['drawElements', 'drawArrays', 'drawElementsInstanced', 'drawArraysInstanced'])
    WebGL2RenderingContext.prototype[name] = () => undefined;
}

let passed = 0;
for (let seed = first; seed < first + seeds; seed++) {
  const running = startSession();
  const browser = await launch();
  try {
    const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
    await page.addInitScript(drawNothing);
    const url = `http://127.0.0.1:${port + 1}/?quality=draft`;
    for (let k = 0; k < 60 && !(await page.goto(url).catch(() => null)); k++) await pause(500);
    await page.waitForFunction(() => window.__insula?.ready, null, patience);
    for (const button of await page.locator('.toast button').all()) await button.click({ timeout: 60_000 });
    const view = await practise(new Person(page, seed), Date.now() + 60_000 * minutes);
    const reached = view.goals.every((g) => g.done);
    if (reached) passed++;
    const goals = view.goals.map((g) => `${g.done ? 'reached' : 'not reached'}: ${g.text}`);
    console.log(`${reached ? 'ok ' : 'no '} seed ${seed}: ${[...goals, ...view.faults].join('; ')}`);
  } finally {
    await browser.close();
    await end(running);
  }
}
console.log(`${passed} of ${seeds} seeds reached all goals`);
process.exit(passed >= 0.8 * seeds ? 0 : 1);
