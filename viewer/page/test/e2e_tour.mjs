// SPDX-License-Identifier: GPL-3.0-or-later
// The first-use tour with the real programs in headless Chromium: each step goes on while other things are done, and
// ends when its own is done, once by mouse and once by keys. Exit status 77: no browser, no programs or no multicast,
// skipped.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { check, patience } from './browser.mjs';
import { byKeys, byMouse, tooLittle } from './first_use/tour_deeds.mjs';
import { ownBus, Programs } from './programs.mjs';
import { launchUndrawn, openUndrawn } from './undrawn.mjs';

const steps = ['zoom', 'turn', 'right_hand', 'left_hand', 'button', 'exchange', 'choose'];
const programs = new Programs();
const folder = mkdtempSync(join(tmpdir(), 'insula_tour_'));
const scene = 'viewer/page/test/first_use/tour.xml';
const { address } = await programs.play(folder, ['--no-record', '--no-report', scene], ownBus(11000));

const browser = await launchUndrawn();
const page = await openUndrawn(browser, { width: 1000, height: 700 });
const errors = [];
page.on('pageerror', (e) => errors.push(e.message));

const shown = () => page.evaluate(() => window.__insula.tour);
const shows = (step) => page.waitForFunction((s) => window.__insula.tour === s, step, patience);
const title = () => page.locator('.tour b').textContent();

/** Until the engine has answered what was done, and the page has drawn it. */
async function seen() {
  await page.waitForTimeout(300);
  const { frames, pictures } = await page.evaluate(() => ({ ...window.__insula }));
  const later = ([f, p]) => window.__insula.frames > f + 10 && window.__insula.pictures > p + 2;
  await page.waitForFunction(later, [frames, pictures], patience);
}

/** What does not end that step: all other deeds, and too little of its own. */
async function goesOn(step, deeds, dir) {
  for (const other of steps.filter((s) => s !== step)) await deeds[other](page, dir);
  await tooLittle[step](page, dir);
  await seen();
  assert.equal(await shown(), step, `${step} goes on after all other deeds and too little of its own`);
}

/** first: the direction of the first step's deeds; the next ones go to and fro. */
async function goThrough(deeds, first, others) {
  for (const [k, step] of steps.entries()) {
    const dir = k % 2 === 0 ? first : -first;
    await shows(step);
    assert.match(await title(), new RegExp(`^${k + 1} of ${steps.length}: `));
    if (others) await goesOn(step, deeds, dir);
    // On a slow machine a hand gets less far while a key is held.
    for (let tries = 0; tries < 6 && (await shown()) === step; tries++) {
      await deeds[step](page, dir);
      await seen();
    }
    assert.notEqual(await shown(), step, `${step} ends by its own deed`);
    await shows(steps[k + 1] ?? 'end');
  }
}

try {
  await page.goto(`${address}?quality=draft`);
  await page.locator('[data-answer=practice]').click(patience);
  await shows('offer');
  await byMouse.zoom(page, 1);
  await seen();
  assert.equal(await shown(), 'offer', 'nothing counts before the tour has begun');
  await page.locator('[data-tour=go]').click(patience);
  await goThrough(byMouse, -1, true);
  check('by mouse each step goes on after all other deeds, and ends by its own');

  await page.locator('[data-tour=leave]').click(patience);
  await shows('');
  await page.locator('[data-tour=begin]').click(patience);
  await goThrough(byKeys, 1, false);
  check('the tour begins again, and goes to its end by keys');
  assert.deepEqual(errors, []);
} finally {
  await browser.close();
  await programs.end();
  rmSync(folder, { recursive: true, force: true });
}
