// SPDX-License-Identifier: GPL-3.0-or-later
// What the browser test of the case builder's page does with the mouse on its pictures.
import assert from 'node:assert/strict';
import { axeFinds } from './axe.mjs';
import { patience, waitFor } from './browser.mjs';
import { shots } from './studio_page.mjs';

const shot = shots('studio');

export const project = (page, name) =>
  page.evaluate(async (n) => (await fetch(`api/studio/project?name=${n}`)).json(), name);

/** Of the vessel at a point of it, wherever the page has scrolled to. */
const colourOf = (page, point) => page.evaluate((p) => window.__studio.colourAt(...window.__studio.screenOf(p)), point);

const pause = (ms) => new Promise((r) => setTimeout(r, ms));

/** Places on the way of a hand that aims 2 px beside, shakes by 1.5 px and overshoots a little. */
function unsteadyWay([x, y], [dx, dy], steps = 12) {
  const end = [x + 1.06 * dx, y + 1.06 * dy];
  const shake = (k) => [1.5 * Math.sin(2.3 * k), 1.5 * Math.cos(1.7 * k)];
  const way = Array.from({ length: steps + 1 }, (_, k) => {
    const share = k / steps;
    const [sx, sy] = shake(k);
    return [x + 1.6 + share * (end[0] - x) + sx, y - 1.2 + share * (end[1] - y) + sy];
  });
  return [...way, [x + dx, y + dy]];
}

/** A press, a drag and a release of the mouse, as a hand does it. whileDown: before the release. */
async function drag(page, from, by, whileDown = () => undefined) {
  const way = unsteadyWay(from, by);
  await page.mouse.move(...way[0]);
  await pause(60); // a gizmo shows what is below the pointer
  await page.evaluate(() => new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r)))); // it is drawn
  await page.mouse.down();
  for (const place of way.slice(1)) {
    await page.mouse.move(...place);
    await pause(15);
  }
  await whileDown();
  await page.mouse.up();
}

const values = (page) =>
  page.locator('.wall-paint .rule').evaluateAll((all) => all.map((one) => one.getAttribute('aria-label')));

/** A plaque is painted onto the dome, undone, done again, made stiffer, grown and partly erased. */
export async function paintAPlaque(page, { centre, normal, diameter_mm: width }) {
  const patches = async () => (await project(page, 'narrow_neck')).choices.wall_patches;
  const one = () => waitFor('a painted part', async () => (await patches()).length === 1);
  const screenOf = (p) => page.evaluate((at) => window.__studio.screenOf(at), p);
  const inSight = () => page.evaluate(() => document.querySelector('.view').scrollIntoView({ block: 'nearest' }));
  await page.getByRole('button', { name: 'Paint a new part' }).click();
  const above = centre.map((c, k) => c + 0.8 * width * normal[k]);
  const dome = await page.evaluate((p) => window.__studio.placeAt(...window.__studio.screenOf(p)), above);
  const bare = await colourOf(page, dome);
  await drag(page, await screenOf(dome), [24, 10]);
  await one();
  const [painted] = await patches();
  assert.ok(painted.points.length >= 2, JSON.stringify(painted));
  const beside = Math.hypot(...painted.points[0].map((x, k) => x - dome[k]));
  assert.ok(beside < 0.5, `painting began ${beside} mm beside the place`);
  await waitFor('the colour of the part', async () => (await colourOf(page, dome))[1] > bare[1] + 0.2);
  await shot(page, 'painted_first', { fullPage: false });
  await page.keyboard.press('Control+z');
  await waitFor('no painted part', async () => (await patches()).length === 0);
  await waitFor('the colour before', async () => (await colourOf(page, dome))[1] === bare[1]);
  await page.keyboard.press('Control+Shift+Z');
  await one();
  const part = page.getByRole('group', { name: 'Part 1' });
  await part.getByLabel('Stiffness (Young’s modulus)').fill('8 kg');
  await page.locator('[id="patch-0-young-about"].bad').waitFor(patience);
  await part.getByLabel('Stiffness (Young’s modulus)').fill('8');
  await page.keyboard.press('Tab');
  await waitFor('a stiffer part', async () => (await patches())[0].young === '8 MPa');
  await inSight();
  await drag(page, await screenOf(dome), [-6, -34]); // the brush is still held
  await waitFor('a larger part', async () => (await patches())[0].points.length > painted.points.length);
  const grown = (await patches())[0].points.length;
  await part.getByRole('button', { name: 'Erase' }).click();
  await drag(page, await screenOf(painted.points.at(-1)), [3, 2]);
  await waitFor('a smaller part', async () => (await patches())[0].points.length < grown);
  await part.getByRole('button', { name: 'Stop erasing' }).click();
  assert.deepEqual(await values(page), ['Part 1']);
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'painted');
  return (await patches())[0].points.length;
}

const apart = (a, b) => Math.hypot(...[0, 1, 2].map((k) => a[k] - b[k]));

/** Longer than the gizmo's middle, within its arrows and rings, mm. */
const onArrowMm = 3.6;
const onRingMm = 4.5;

/** The arrow that lies most across the view: where it is taken, and 9 px along it. */
async function longestArrow(handle) {
  const [x, y] = await handle(0, 0, 0);
  const ends = await Promise.all([0, 1, 2].map((k) => handle(...[0, 1, 2].map((j) => (j === k ? onArrowMm : 0)))));
  const length = ([a, b]) => Math.hypot(a - x, b - y);
  const end = ends.reduce((best, one) => (length(one) > length(best) ? one : best));
  return [end, [(9 * (end[0] - x)) / length(end), (9 * (end[1] - y)) / length(end)]];
}

/** Along one arrow, where nothing is turned; then around a ring, where the neck stays. */
async function alongAndAround(page, moved, { pose, parted, handle }) {
  const axis = await page.evaluate(() => window.__pose.pose().slice(3));
  const [arrow, way] = await longestArrow(handle);
  await drag(page, arrow, way);
  await waitFor('a place along an arrow', async () => apart(await pose(), moved) > 0.02);
  const along = await pose();
  assert.deepEqual(along.slice(3), axis, 'an arrow turns nothing');
  await parted(true);

  await page.getByRole('button', { name: 'Turn', exact: true }).click();
  const neck = await handle(0, 0, 0);
  const [rx, ry] = await handle(onRingMm * Math.SQRT1_2, onRingMm * Math.SQRT1_2, 0);
  await drag(page, [rx, ry], [12, 14]);
  await waitFor('another turn', async () => (await pose()).slice(3).some((x, k) => Math.abs(x - along[3 + k]) > 0.5));
  const turned = await pose();
  const neckNow = await handle(0, 0, 0);
  assert.ok(Math.hypot(neckNow[0] - neck[0], neckNow[1] - neck[1]) < 1, 'it turns about the neck');
  await parted(true);
  return { along, turned };
}

/** The vessel is moved and turned by its gizmo, with keys for undo. */
export async function moveTheVessel(page) {
  const told = (what) => page.locator(`.pose-facts [data-what=${what}] td`).innerText();
  const parted = (yes) => page.locator(`.pose-facts caption[data-parted=${yes}]`).waitFor(patience);
  const pose = async () => (await project(page, 'narrow_neck')).choices.pose;
  const handle = (...mm) => page.evaluate((at) => window.__pose.handle(at), mm);
  await page.getByRole('button', { name: 'Move the vessel' }).click();
  await page.waitForFunction(() => window.__pose?.handle, null, patience);
  await parted(true);
  await page.waitForFunction(() => window.__pose.parted(), null, patience);
  const { overlap_mm: overlap } = (await project(page, 'narrow_neck')).built.report;
  for (const lobe of ['frontal', 'temporal', 'insula'])
    assert.ok(Math.abs(parseFloat(await told(lobe)) - overlap[lobe]) < 0.011, `${lobe}: ${await told(lobe)}`);
  assert.match(await told('seen'), /^\d+ %$/);
  await shot(page, 'place', { fullPage: false });
  const before = await page.evaluate(() => window.__pose.pose());

  // By the middle, in the plane of the picture. What is told follows the hand.
  const middle = await handle(0, 0, 0);
  await drag(page, middle, [7, -4], async () => {
    await parted(false);
    await shot(page, 'moving', { fullPage: false });
    assert.equal(await pose(), null, 'nothing is chosen before the release');
    assert.ok(!(await page.evaluate(() => window.__pose.parted())), 'the lobes are as they are before');
    await page.waitForTimeout(1500); // while the page asks how the case is
    await parted(false);
  });
  await waitFor('another place', async () => (await pose()) !== null);
  const moved = await pose();
  assert.ok(apart(moved, before) > 0.05 && apart(moved, before) < 8, `${before} to ${moved}`);
  await parted(true);

  const { along, turned } = await alongAndAround(page, moved, { pose, parted, handle });
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'moved', { fullPage: false });

  // Beside it, a drag looks from elsewhere.
  const box = await page.locator('.pose-view canvas').boundingBox();
  await drag(page, [box.x + 40, box.y + 60], [130, -50]);
  assert.deepEqual(await pose(), turned);
  await shot(page, 'looked', { fullPage: false });

  await page.locator('.pose-view canvas').focus();
  await page.keyboard.press('Control+z');
  await waitFor('the turn before', async () => apart((await pose()) ?? before, along) < 1e-9);
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await waitFor('the place before', async () => (await pose()) === null);
  await page.waitForFunction((x) => Math.abs(window.__pose.pose()[0] - x) < 2e-3, before[0], patience);
  await page.keyboard.press('Control+Shift+Z');
  await waitFor('the place again', async () => (await pose()) !== null);
  const mm = apart(moved, before);
  await page.getByRole('button', { name: 'Put the picture away' }).click();
  return { moved, mm };
}

/** Of the third retractor: along an arrow of its gizmo, then its pull as a number, which must not be too large. */
async function changeTheThird(page, { chosen, handle }) {
  const before = (await chosen())[2];
  const [arrow, way] = await longestArrow((...mm) => handle(2, ...mm));
  await drag(page, arrow, way, async () => {
    await shot(page, 'retractor_moving', { fullPage: false });
    assert.deepEqual((await chosen())[2], before, 'nothing is chosen before the release');
  });
  await waitFor('another place', async () => apart((await chosen())[2].tip_mm, before.tip_mm) > 0.02);
  const moved = (await chosen())[2];
  const mm = apart(moved.tip_mm, before.tip_mm);
  assert.ok(mm < 8, `it was moved by ${mm} mm`);
  assert.ok(apart(moved.shaft, before.shaft) + apart(moved.flat, before.flat) < 1e-3, 'an arrow turns nothing');
  const pull = page.getByRole('group', { name: 'Retractor 3' }).getByLabel('Draws the lobe aside by');
  await pull.fill('16');
  await page.locator('[id="retractor-2-pull-about"].bad').waitFor(patience);
  await pull.fill('6.5');
  await page.keyboard.press('Tab');
  await waitFor('another pull', async () => (await chosen())[2].pull_mm === 6.5);
  return mm;
}

/** A retractor is added by keys, moved by its gizmo, removed by the mouse, and all of that is undone. */
export async function addARetractor(page) {
  const chosen = async () => (await project(page, 'narrow_neck')).choices.retractors;
  const handle = (k, ...mm) => page.evaluate(([n, at]) => window.__retractors.handle(n, at), [k, mm]);
  const inPicture = () => page.evaluate(() => [window.__retractors.all().length, window.__retractors.chosen()]);
  const shown = (n) =>
    waitFor(`${n} retractors`, async () => {
      const rows = await page.locator('.retractors .rule').count();
      return rows === n && (await inPicture())[0] === n;
    });
  await page.getByRole('button', { name: 'Change the retractors' }).click();
  await page.waitForFunction(() => window.__retractors?.handle, null, patience);
  await shown(2);
  assert.equal(await chosen(), null, 'they are as proposed');
  await page.getByRole('button', { name: 'Add a retractor' }).focus();
  await page.keyboard.press('Enter');
  await shown(3);
  assert.deepEqual(await inPicture(), [3, 2], 'the new one is chosen');
  const mm = await changeTheThird(page, { chosen, handle });
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'retractors', { fullPage: false });
  await shot(page, 'retractors_page');
  const blade = await handle(0, 0, 0, 4);
  await page.mouse.click(...blade);
  await waitFor('the clicked one', async () => (await inPicture())[1] === 0);

  await page.getByRole('group', { name: 'Retractor 3' }).getByRole('button', { name: 'Remove' }).click();
  await shown(2);
  const undo = async () => {
    await page.locator('.pose-view canvas').focus();
    await page.keyboard.press('Control+z');
  };
  await undo();
  await shown(3);
  assert.equal((await chosen())[2].pull_mm, 6.5);
  for (let k = 0; k < 3; k++) await undo();
  await waitFor('those of the approach', async () => (await chosen()) === null);
  await shown(2);
  const frontal = page.getByRole('group', { name: 'Retractor 2' }).getByLabel('Draws the lobe aside by');
  await frontal.fill('5.5');
  await page.keyboard.press('Tab');
  await waitFor('another pull', async () => (await chosen())?.[1].pull_mm === 5.5);
  await page.getByRole('button', { name: 'Put the picture away' }).click();
  return { mm, retractor: (await chosen())[1] };
}
