// SPDX-License-Identifier: GPL-3.0-or-later
// The start page with the real programs in headless Chromium: somebody adds himself, begins another exercise than the
// running one by keys and clicks, and finds his run on its card. Exit status 77: no browser, no programs or no
// multicast, skipped.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { check, launch, patience } from './browser.mjs';
import { ownBus, Programs } from './programs.mjs';

const programs = new Programs();
const folder = mkdtempSync(join(tmpdir(), 'insula_start_'));
const { address } = await programs.play(folder, ['--no-record'], ownBus(7000));

const browser = await launch();
const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
const page = await context.newPage();
const errors = [];
page.on('pageerror', (e) => errors.push(e.message));
try {
  await page.goto(address);
  await page.waitForSelector('.card', patience);
  assert.ok((await page.locator('.card').count()) >= 4, 'the exercises are there');
  assert.equal(await page.inputValue('#person'), '', 'a guest at first');
  check('a start page shows the exercises, and a guest needs nothing');

  const room = page.getByRole('link', { name: 'The room' });
  await room.waitFor(patience);
  const reached = () => room.evaluate((link) => link === document.activeElement);
  for (let k = 0; k < 60 && !(await reached()); k++) await page.keyboard.press('Tab');
  assert.ok(await reached(), 'the way to the room by keys');
  await page.keyboard.press('Enter');
  await page.waitForURL(/room\.html/, patience);
  await page.getByText('No stations are listed yet.').waitFor(patience);
  await page.goBack();
  await page.waitForSelector('.card', patience);
  check('keys lead to the room and back');

  await page.getByRole('button', { name: 'Add a person' }).click();
  await page.keyboard.type('P07');
  await page.getByLabel('Year of training').fill('3');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.querySelector('#person').value === 'P07', null, patience);
  await page.getByRole('button', { name: 'Add a person' }).click();
  await page.keyboard.type('p07');
  await page.keyboard.press('Enter');
  await page.getByText('the pseudonym "p07" is in use').waitFor(patience);
  check('a person is added by keys, and a pseudonym that is in use is refused in words');

  const choice = () => page.evaluate(async () => (await fetch('api/state')).json());
  const other = page.locator('.card', { hasText: '3 Clipping' });
  assert.match((await choice()).scene, /1_sylvian_fissure/);
  await other.getByRole('button', { name: /Begin/ }).click();
  await page.waitForURL(/index\.html/, patience);
  const running = await choice();
  assert.deepEqual([running.scene, running.person], ['scenes/training/3_clipping.xml', 'P07']);
  await page.waitForFunction(() => window.__insula?.ready, null, patience);
  await page.locator('[data-answer=practice]').click(patience);
  await page.waitForFunction(() => window.__insula.frames > 60, null, patience);
  check('another exercise begins without a terminal, under the name of the person');

  await page.goto(address);
  await page.locator('.card', { hasText: '1 Opening' }).getByRole('button', { name: /Begin/ }).click();
  await page.waitForURL(/index\.html/, patience);
  await page.goto(address);
  // The page remembers who is here.
  await page.waitForFunction(() => document.querySelector('#person')?.value === 'P07', null, patience);
  await other.getByText('begun').waitFor(patience);
  await other.getByRole('button', { name: /Progress/ }).click();
  await page.locator('dialog[open] .curve svg circle').first().waitFor(patience);
  await page.keyboard.press('Escape');
  check('the run is on the card, with a curve for each metric');
  assert.deepEqual(errors, []);
} finally {
  await browser.close();
  await programs.end();
  rmSync(folder, { recursive: true, force: true });
}
