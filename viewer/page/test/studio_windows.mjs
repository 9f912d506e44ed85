// SPDX-License-Identifier: GPL-3.0-or-later
// One case in two windows of the studio.
import assert from 'node:assert/strict';
import { patience, waitFor } from './browser.mjs';
import { project } from './studio_deeds.mjs';
import { shots, viewport } from './studio_page.mjs';

const shot = shots('studio');
const difficulty = (page) => page.getByLabel('Difficulty');
const choices = async (page) => (await project(page, 'narrow_neck')).choices;

/** A page asks for changes of other windows from time to time. */
const showsChoice = (page, value) =>
  page.waitForFunction((v) => [...document.querySelectorAll('select')].some((s) => s.value === v), value, patience);

/** Until it asks for its next deed, the page hears nothing new. */
async function deafUntilItsNextDeed(page) {
  const before = await project(page, 'narrow_neck');
  let deaf = true;
  const ended = async (route) => {
    deaf = false;
    await route.continue();
  };
  await page.route('**/api/studio/choose', ended);
  await page.route('**/api/studio/project?*', (route) => (deaf ? route.fulfill({ json: before }) : route.continue()));
}

/** A second window sees what the first one changes, and overwrites nothing that it has not seen. */
export async function twoWindows(page, address) {
  const other = await page.context().browser().newPage({ viewport });
  other.setDefaultTimeout(patience.timeout);
  await other.goto(`${address}#narrow_neck`);
  const before = await choices(page);
  await difficulty(other).waitFor(patience);
  await difficulty(page).selectOption('2');
  const began = performance.now();
  await showsChoice(other, '2');
  const seconds = (performance.now() - began) / 1000;

  await deafUntilItsNextDeed(other);
  await difficulty(page).selectOption('4');
  await waitFor('the first change', async () => (await choices(page)).difficulty === 4);
  await other.getByLabel('Fineness of the wall').selectOption('1200');
  await other.getByText('The case was changed in another window.').waitFor(patience);
  assert.deepEqual(await choices(page), { ...before, difficulty: 4 }, 'nothing is overwritten');
  assert.equal(await difficulty(other).inputValue(), '4', 'the state of the first window is shown');
  await shot(other, 'two_windows', { fullPage: false });
  await other.getByRole('button', { name: 'Make my change all the same' }).click();
  await waitFor('both changes', async () => (await choices(page)).vertices === 1200);
  assert.deepEqual(await choices(page), { ...before, difficulty: 4, vertices: 1200 });
  await other.getByText('The case was changed in another window.').waitFor({ state: 'hidden', ...patience });
  await other.close();
  // An undo of what a page has not shown yet is refused.
  await showsChoice(page, '1200');
  for (let k = 0; k < 3; k++) await page.getByRole('button', { name: 'Undo' }).click();
  await waitFor('the choices before', async () => (await choices(page)).difficulty === before.difficulty);
  assert.deepEqual(await choices(page), before, 'undo is of the case, whichever window has changed it');
  return seconds;
}

/** A window whose case is removed in another one says so, and lets nothing be done to it. */
export async function removedElsewhere(page, address) {
  const other = await page.context().browser().newPage({ viewport });
  other.setDefaultTimeout(patience.timeout);
  await other.goto(`${address}#narrow_neck`);
  await difficulty(other).waitFor(patience);
  await page.getByRole('link', { name: 'All projects' }).click();
  page.once('dialog', (d) => d.accept());
  await page.getByRole('button', { name: 'Remove narrow_neck' }).click();
  await other.getByText('This case is not there any more').waitFor(patience);
  assert.equal(await other.locator('.editor .columns').getAttribute('inert'), '');
  const asked = [];
  other.on('request', (r) => asked.push(r.url()));
  await other.waitForTimeout(2000);
  assert.deepEqual(asked, [], 'nothing is asked any more');
  await other.close();
}
