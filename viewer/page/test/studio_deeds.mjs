// SPDX-License-Identifier: GPL-3.0-or-later
// What the browser test of the case builder's page does with the mouse on its pictures.
import assert from 'node:assert/strict';
import { axeFinds } from './axe.mjs';
import { patience, waitFor } from './browser.mjs';
import { shots } from './studio_page.mjs';

const shot = shots('studio');

export const project = (page, name) =>
  page.evaluate(async (n) => (await fetch(`api/studio/project?name=${n}`)).json(), name);

const colourAt = (page, [x, y]) => page.evaluate(([a, b]) => window.__studio.colourAt(a, b), [x, y]);

/** A press, a drag and a release of the mouse. */
async function drag(page, from, by, whileDown = () => undefined) {
  await page.mouse.move(...from);
  await page.mouse.down();
  await page.mouse.move(from[0] + by[0], from[1] + by[1], { steps: 8 });
  await whileDown();
  await page.mouse.up();
}

/** A plaque is painted onto the dome, undone, done again and made stiffer. */
export async function paintAPlaque(page, { centre, normal, diameter_mm: width }) {
  const patches = async () => (await project(page, 'narrow_neck')).choices.wall_patches;
  const one = () => waitFor('a painted part', async () => (await patches()).length === 1);
  await page.getByRole('button', { name: 'Paint a new part' }).click();
  const dome = centre.map((c, k) => c + 0.8 * width * normal[k]);
  const place = await page.evaluate((p) => window.__studio.screenOf(p), dome);
  const bare = await colourAt(page, place);
  const expected = await page.evaluate(([x, y]) => window.__studio.placeAt(x, y), place);
  await drag(page, place, [24, 10]);
  await one();
  const [painted] = await patches();
  assert.ok(painted.points.length >= 2, JSON.stringify(painted));
  assert.ok(
    Math.hypot(...painted.points[0].map((x, k) => x - expected[k])) < 0.01,
    `${painted.points[0]}: ${expected}`,
  );
  await page.waitForFunction(
    ([x, y, green]) => window.__studio.colourAt(x, y)[1] > green + 0.2,
    [...place, bare[1]],
    patience,
  );
  await page.getByRole('button', { name: 'Undo' }).click();
  await waitFor('no painted part', async () => (await patches()).length === 0);
  await waitFor('the colour before', async () => (await colourAt(page, place))?.[1] === bare[1]);
  await page.getByRole('button', { name: 'Redo' }).click();
  await one();
  const part = page.getByRole('group', { name: 'Part 1' });
  await part.getByLabel('Stiffness (Young’s modulus)').fill('8 kg');
  await page.locator('[id="patch-0-young-about"].bad').waitFor(patience);
  await part.getByLabel('Stiffness (Young’s modulus)').fill('8');
  await page.keyboard.press('Tab');
  await waitFor('a stiffer part', async () => (await patches())[0].young === '8 MPa');
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'painted');
  return painted.points.length;
}

/** The vessel is moved by its gizmo. */
export async function moveTheVessel(page) {
  const told = (what) => page.locator(`.pose-facts [data-what=${what}] td`).innerText();
  const parted = (yes) => page.locator(`.pose-facts caption[data-parted=${yes}]`).waitFor(patience);
  const pose = async () => (await project(page, 'narrow_neck')).choices.pose;
  await page.getByRole('button', { name: 'Move the vessel' }).click();
  await page.waitForFunction(() => window.__pose?.handle, null, patience);
  await parted(true);
  const { overlap_mm: overlap } = (await project(page, 'narrow_neck')).built.report;
  for (const lobe of ['frontal', 'temporal', 'insula'])
    assert.ok(Math.abs(parseFloat(await told(lobe)) - overlap[lobe]) < 0.011, `${lobe}: ${await told(lobe)}`);
  const before = await page.evaluate(() => window.__pose.pose());
  await drag(page, await page.evaluate(() => window.__pose.handle()), [9, 4], () => parted(false));
  await waitFor('another place', async () => (await pose()) !== null);
  const moved = await pose();
  const mm = Math.hypot(...[0, 1, 2].map((k) => moved[k] - before[k]));
  assert.ok(mm > 0.05 && mm < 5, `${before} to ${moved}`);
  await parted(true);
  assert.match(await told('seen'), /^\d+ %$/);
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'moved');
  await page.getByRole('button', { name: 'Undo' }).click();
  await waitFor('the place before', async () => (await pose()) === null);
  await page.waitForFunction((x) => Math.abs(window.__pose.pose()[0] - x) < 2e-3, before[0], patience);
  await page.getByRole('button', { name: 'Redo' }).click();
  await waitFor('the place again', async () => (await pose()) !== null);
  await page.getByRole('button', { name: 'Put the picture away' }).click();
  return { moved, mm };
}
