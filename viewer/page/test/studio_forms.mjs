// SPDX-License-Identifier: GPL-3.0-or-later
// Goals, limits and strands of a case, changed by the forms of the studio.
import assert from 'node:assert/strict';
import { isDeepStrictEqual } from 'node:util';
import { axeFinds } from './axe.mjs';
import { patience, waitFor } from './browser.mjs';
import { project } from './studio_deeds.mjs';
import { picture, shots, step } from './studio_page.mjs';

const shot = shots('studio');
const rulesOf = async (page) => (await project(page, 'narrow_neck')).choices.rules;

async function fillIn(field, value) {
  await field.fill(value);
  await field.press('Tab');
}

/** The answer to a change arrives when the text of the next field is marked, and before it is typed over. */
async function typedOverAnAnswer(page, [field, value], [next, nextValue]) {
  let answer;
  const marked = new Promise((done) => (answer = done));
  const late = async (route) => {
    await marked;
    await route.continue();
  };
  await page.route('**/api/studio/choose', late, { times: 1 });
  await fillIn(field, value);
  await next.click({ clickCount: 3 });
  const before = await next.elementHandle();
  answer();
  await waitFor('fields that are written anew', () => before.evaluate((e) => !e.isConnected));
  await page.keyboard.type(nextValue);
  await page.keyboard.press('Tab');
}

/** A goal, a clock and strands are changed; the last change is undone and made again. */
export async function goalsAndStrands(page) {
  const remnant = page.getByLabel('Worst remnant that is accepted (Sindou grade)');
  await remnant.waitFor(patience);
  await remnant.fill('9');
  await page.getByText('Outside the allowed range: 0 to 5').waitFor(patience);
  await fillIn(remnant, '1');
  await page.getByRole('checkbox', { name: 'Fifteen minutes are over' }).uncheck();
  await page.getByText('Choices have changed since: build again.').waitFor(patience);
  await page.locator('.goals').getByRole('combobox', { name: 'Exercise' }).selectOption('2');
  const strands = page.getByRole('group', { name: 'Strands to the frontal lobe' });
  const [density, stiffness] = [strands.getByLabel('How densely they stand'), strands.getByLabel('Stiffness')];
  await fillIn(density, '31');
  // At once, before the change before it is answered.
  await fillIn(stiffness, '70');
  await waitFor('both changes', async () => (await rulesOf(page)).length === 4);
  await typedOverAnAnswer(page, [density, '30'], [stiffness, '80']);
  const ofStrands = ['2.to_frontal.density=30 1/cm2', '2.to_frontal.stiffness=80 N/m'];
  const rules = ['3.clip.max_grade=1', '3.time=off', ...ofStrands];
  const ruled = () => waitFor(`rules ${rules}`, async () => isDeepStrictEqual(await rulesOf(page), rules));
  await ruled();
  await page.getByRole('button', { name: 'Undo' }).click();
  await waitFor('the stiffness before', async () => (await stiffness.inputValue()) === '70');
  await page.getByRole('button', { name: 'Redo' }).click();
  await ruled();
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'goals');
  await picture(page, 'goals', step(page, '6. Goals and limits'));
}
