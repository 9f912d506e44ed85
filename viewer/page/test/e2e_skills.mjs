// SPDX-License-Identifier: GPL-3.0-or-later
// Skill tasks with the real programs in headless Chromium: a person with human errors, who has one mouse and does what
// the guide's panel says, reaches all goals of each. node test/e2e_skills.mjs [TASK ...] [--seed 1]; TASK is the
// beginning of a file's name. With INSULA_SHOTS=FOLDER pictures are drawn and kept there. Exit status 77: no browser,
// no programs or no multicast, skipped.
import assert from 'node:assert/strict';
import { mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { check, patience } from './browser.mjs';
import { Person } from './human_hands.mjs';
import { Practice } from './human_practice.mjs';
import { ownBus, Programs, root } from './programs.mjs';
import { drawn, launchUndrawn, openUndrawn } from './undrawn.mjs';

const viewport = { width: 1280, height: 800 };
const shots = process.env.INSULA_SHOTS;
const folder = join(root, 'scenes/skills');
const { values, positionals: asked } = parseArgs({
  allowPositionals: true,
  options: { seed: { type: 'string', default: '1' } },
});
const seed = Number(values.seed);
/** Those that take less than a minute; the others take two. */
const usual = ['4', '5', '6'];
const tasks = readdirSync(folder).filter(
  (f) => f.endsWith('.xml') && (asked.length > 0 ? asked : usual).some((name) => f.startsWith(name)),
);
/** On a machine that keeps up; a slow one has the exercise's own time limit. */
const longestMs = 400_000;

async function openPage(browser, address) {
  const page = await openUndrawn(browser, viewport);
  await page.goto(`${address}?quality=draft`);
  await page.waitForFunction(() => window.__insula?.ready, null, patience);
  for (const button of await page.locator('.toast button').all()) await button.click(patience);
  await page.getByRole('button', { name: 'Not now' }).click(patience);
  return page;
}

const shown = (view) => view.goals.map((g) => `${g.done ? 'reached' : 'not reached'}: ${g.text}`).join('; ');

/** Practises until the exercise says that it is over; keeps pictures of begin, middle and end. */
async function practise(page, name) {
  const keep = async (when) => {
    const path = join(shots ?? '', `${name}_${when}.png`);
    if (shots) await drawn(page, () => page.screenshot({ path, timeout: patience.timeout }));
  };
  await keep('begin');
  const practice = new Practice(new Person(page, seed), () => true);
  const end = Date.now() + longestMs;
  let view = await practice.person.look();
  for (let half = false; Date.now() < end && view.end === '';) {
    view = await practice.next(view);
    const done = view.goals.filter((g) => g.done).length;
    if (!half && done >= view.goals.length / 2) {
      half = true;
      await keep('middle');
    }
  }
  await keep('end');
  return view;
}

async function task(file) {
  const programs = new Programs();
  const data = mkdtempSync(join(tmpdir(), 'insula_skills_'));
  const words = ['--no-record', '--no-report', '--motion', 'none', '--mode', 'practice', join(folder, file)];
  const { address } = await programs.play(data, words, ownBus(13000));
  const browser = await launchUndrawn();
  try {
    const page = await openPage(browser, address);
    const errors = [];
    page.on('pageerror', (e) => errors.push(e.message));
    const began = Date.now();
    const view = await practise(page, file.replace('.xml', ''));
    assert.ok(view.goals.length > 0 && view.goals.every((g) => g.done), `${file}: ${shown(view)}`);
    assert.equal(view.target, null, 'after the end there is no target');
    assert.deepEqual(errors, []);
    const seconds = ((Date.now() - began) / 1000).toFixed(0);
    check(`${file}: all ${view.goals.length} goals by one mouse in ${seconds} s, faults: ${view.faults.join(', ')}`);
  } finally {
    await browser.close();
    await programs.end();
    rmSync(data, { recursive: true, force: true });
  }
}

for (const file of tasks) await task(file);
