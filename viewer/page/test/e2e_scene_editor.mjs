// SPDX-License-Identifier: GPL-3.0-or-later
// A shipped scene is edited as a copy in the studio, with the real programs: a property changes its text, a mistake is
// told and taken back, the scene is looked at while it changes, and a tool is placed with the mouse. Exit status 77: no
// browser or no programs, skipped.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { axeFinds } from './axe.mjs';
import { check, launch, patience, waitFor } from './browser.mjs';
import { ownBus, Programs, root } from './programs.mjs';
import { shots } from './studio_page.mjs';

const programs = new Programs();
const data = mkdtempSync(join(tmpdir(), 'insula_scenes_'));
const shipped = join(root, 'scenes/training/1_sylvian_fissure.xml');
const original = readFileSync(shipped, 'utf8');
const copy = join(data, 'scenes/1_sylvian_fissure/scenes/training/1_sylvian_fissure.xml');

const shot = shots('scene', { timeout: patience.timeout });

const onDisk = (file) => readFileSync(file, 'utf8');
const item = (page, name, of) => page.getByRole('treeitem').filter({ hasText: `${name}${of}` });
const saved = (page) => page.getByText('Saved', { exact: true }).waitFor(patience);

const picture = (page) => page.frames().find((f) => f !== page.mainFrame() && f.url().startsWith('http'));

/** Starts the running picture. */
async function lookAtIt(page) {
  await page.getByRole('button', { name: 'Look at it' }).click();
  await page.locator('.live iframe').waitFor(patience);
  await waitFor('picture', () => picture(page));
  await picture(page).waitForFunction(() => window.__insula?.ready, null, patience);
}

/** Adds an element to the chosen one. */
async function add(page, element) {
  await page.getByLabel('Element to be added').selectOption(element);
  await page.getByRole('button', { name: 'Add', exact: true }).click();
}

/** A block of tissue becomes a scene, from the list of components to the running picture. */
async function beginFromNothing(page) {
  const file = join(data, 'scenes/my_block/my_block.xml');
  await page.getByText('A new scene from nothing').click();
  await page.getByLabel('Name: letters, digits, _ and -').fill('my block');
  await page.locator('[data-element=soft_body]').check();
  await page.getByRole('button', { name: 'Begin the scene' }).click();
  await page.getByText('letters, digits, _ and - only').waitFor(patience);
  await page.getByLabel('Name: letters, digits, _ and -').fill('my_block');
  await shot(page, 'new');
  assert.deepEqual(await axeFinds(page), []);
  await page.getByRole('button', { name: 'Begin the scene' }).click();
  await page.locator('.scene-editor .cm-content').waitFor(patience);
  await page.locator('.found button').first().waitFor(patience);
  await page.getByText('Not saved: the scene has errors').waitFor(patience);
  assert.doesNotMatch(onDisk(file), /soft_body/);
  check('a scene is begun from nothing, and its problems are listed at once');

  const body = () => item(page, 'soft_body', 'soft_body').click();
  await body();
  await page.getByLabel('mesh (required)', { exact: true }).fill('meshes/examples/block.msh');
  await page.keyboard.press('Enter');
  for (const element of ['corotational_fem', 'fixed', 'surface']) {
    await body();
    await add(page, element);
  }
  await saved(page);
  await waitFor('saved scene', () => /<corotational_fem/.test(onDisk(file)));
  check('a block of tissue is put together from its components and saved by its name');
  await lookAtIt(page);
  const seen = picture(page);
  await shot(page, 'new_live');
  const bodies = () => seen.evaluate(() => [window.__insula.session, window.__insula.problems.join()]);
  const [session, problems] = await bodies();
  assert.equal(problems, '');
  // A unit by mistake: forty metres of tissue are shown too.
  await body();
  await page.getByLabel('mesh_unit (required)', { exact: true }).selectOption('m');
  await waitFor('another unit', () => /mesh_unit="m"/.test(onDisk(file)));
  await seen.waitForFunction(
    (before) => window.__insula?.ready && window.__insula.session !== before,
    session,
    patience,
  );
  await page.keyboard.press('Control+z');
  await waitFor('the unit before', () => /mesh_unit="mm"/.test(onDisk(file)));
  await page.getByRole('button', { name: 'Close the picture' }).click();
  await page.getByRole('link', { name: 'All projects' }).click();
  await page.getByRole('link', { name: 'my_block' }).waitFor(patience);
  check('it is shown while it runs, also with a unit by mistake');
}

/** Types at the end of the text. */
async function typeAtEnd(page, words) {
  await page.locator('.cm-content').click();
  await page.keyboard.press('Control+End');
  await page.keyboard.type(words);
}

/** The same file in two windows: neither writes over what the other one has changed unless its author says so. */
async function inTwoWindows(page) {
  const other = await page
    .context()
    .browser()
    .newPage({ viewport: { width: 1366, height: 900 } });
  other.setDefaultTimeout(patience.timeout);
  await other.goto(page.url());
  await other.locator('.scene-editor .cm-content').waitFor(patience);
  await saved(other);
  const shows = (of, words) =>
    waitFor(words, async () => (await of.locator('.cm-content').innerText()).trimEnd().endsWith(words));
  const overtaken = (of) => of.getByText('This file was changed in another window').waitFor(patience);

  await page.bringToFront();
  await typeAtEnd(page, '<!-- first -->');
  await waitFor('first', () => onDisk(copy).endsWith('<!-- first -->'));
  await typeAtEnd(other, '<!-- second -->');
  await overtaken(other);
  await shot(other, 'overtaken');
  assert.deepEqual(await axeFinds(other), []);
  assert.match(onDisk(copy), /<!-- first -->$/);
  await other.getByRole('button', { name: 'Keep my text' }).click();
  await waitFor('second', () => onDisk(copy).endsWith('<!-- second -->'));
  assert.ok(!onDisk(copy).includes('<!-- first -->'));
  await other.getByLabel('Earlier versions').selectOption({ index: 1 });
  await shows(other, '<!-- first -->');
  await waitFor('the first again', () => onDisk(copy).endsWith('<!-- first -->'));
  await other.getByRole('button', { name: 'Undo' }).click();
  await waitFor('the second again', () => onDisk(copy).endsWith('<!-- second -->'));
  check('a text is not written over by another window; its author keeps it, and the other stays a version');

  await typeAtEnd(page, '<!-- third -->');
  await overtaken(page);
  await page.getByRole('button', { name: 'Show the other text' }).click();
  await shows(page, '<!-- second -->');
  await saved(page);
  await page.getByRole('button', { name: 'Undo' }).click();
  await waitFor('third', () => onDisk(copy).endsWith('<!-- first --><!-- third -->'));
  // As when its author comes back to the window; there is none that a browser without a screen could leave.
  await other.evaluate(() => window.dispatchEvent(new Event('focus')));
  await shows(other, '<!-- third -->');
  await other.close();
  check('the other text is shown, the own one is a step back, and an untouched window shows what is new');
}

const studio = programs.start('insula', ['studio', '--no-browser', '--port', '0', '--data', data], ownBus());
const browser = await launch();
try {
  const { address } = await programs.told(studio, /studio is at (\S+)/);
  const page = await browser.newPage({ viewport: { width: 1366, height: 900 } });
  page.setDefaultTimeout(patience.timeout);
  await page.goto(address);
  const source = page.getByLabel('Scene to be copied');
  await source
    .locator('option[value="scenes/training/1_sylvian_fissure.xml"]')
    .waitFor({ state: 'attached', ...patience });
  await source.selectOption('scenes/training/1_sylvian_fissure.xml');
  await shot(page, 'list');
  assert.deepEqual(await axeFinds(page), []);
  await beginFromNothing(page);
  await source.selectOption('scenes/training/1_sylvian_fissure.xml');
  await page.getByRole('button', { name: 'Edit a copy' }).click();
  await page.locator('.scene-editor .cm-content').waitFor(patience);
  await saved(page);
  assert.equal(onDisk(copy), original);
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'opened');
  check('a shipped scene is opened as a copy, and is without problems');

  await item(page, 'dissector', 'right_dissector').click();
  const coupling = page.getByLabel('coupling', { exact: true });
  assert.equal(await coupling.inputValue(), '250');
  await coupling.fill('9000');
  await page.getByText('Outside the allowed range: 10 N/m to 5000 N/m').waitFor(patience);
  await shot(page, 'range');
  await coupling.fill('300');
  await page.keyboard.press('Enter');
  await saved(page);
  await waitFor('saved scene', () => onDisk(copy) !== original);
  const changed = original.replace(/(right_dissector[^]*?coupling=")250 N\/m/, '$1300 N/m');
  assert.notEqual(changed, original);
  assert.equal(onDisk(copy), changed);
  assert.equal(onDisk(shipped), original);
  check('a property changes its value in the text, and every other byte stays');

  await page.getByLabel('Unit of coupling', { exact: true }).selectOption('N/mm');
  await waitFor('other unit', () => onDisk(copy).includes('coupling="0.3 N/mm"'));
  await page.getByRole('button', { name: 'Undo' }).click();
  await waitFor('unit before', () => onDisk(copy) === changed);
  check('a value is told in another unit, and taken back');

  await page.locator('.cm-content').click();
  await page.keyboard.press('Control+Home');
  await page.keyboard.press('Control+f');
  await page.locator('.cm-search input[name=search]').waitFor(patience);
  await page.keyboard.type('tolerance="1e-7');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Escape');
  await page.keyboard.press('ArrowLeft');
  for (let k = 0; k < 'tol'.length; k++) await page.keyboard.press('Delete');
  const found = page.locator('.found button');
  await found.first().waitFor(patience);
  const line = original.slice(0, original.indexOf('tolerance=')).split('\n').length;
  assert.match(
    await found.first().innerText(),
    new RegExp(`1_sylvian_fissure\\.xml:${line}\\s+<solver> has no parameter "erance"`),
  );
  await page.getByText('Not saved: the scene has errors').waitFor(patience);
  assert.equal(onDisk(copy), changed, 'the last good scene stays');
  await page.keyboard.press('Control+End');
  await found.first().click();
  await shot(page, 'problem');
  assert.equal(await page.locator('[role=treeitem][aria-selected=true] .element').innerText(), 'solver');
  assert.deepEqual(await axeFinds(page), []);
  await page.reload();
  await found.first().waitFor(patience);
  check('a mistake is told with its line, is not saved, and is still there after a restart of the page');

  await page.getByLabel('Earlier versions').selectOption({ index: 1 });
  await saved(page);
  await waitFor('earlier version', () => onDisk(copy).includes('0.3 N/mm'));
  await page.getByRole('button', { name: 'Undo' }).click();
  await found.first().waitFor(patience);
  await page.locator('.cm-content').click();
  await page.keyboard.press('Control+Shift+z');
  await saved(page);
  assert.equal(await found.count(), 0);
  check('an earlier version is taken, taken back, and taken again');

  await item(page, 'exercise', 'sylvian_fissure').click();
  await page.getByLabel('Element to be added').selectOption('fault_event');
  await page.getByRole('button', { name: 'Add', exact: true }).click();
  await found.first().waitFor(patience);
  assert.match(await page.locator('.cm-content').innerText(), /<fault_event [^>]*\/>/);
  await shot(page, 'added');
  await page.getByRole('button', { name: 'Remove <fault_event>' }).click();
  await saved(page);
  check('an element is added from the list of what is allowed, and removed');

  const part = copy.replace('training/1_sylvian_fissure', 'parts/metrics');
  const partBefore = onDisk(part);
  await page.locator('.cm-content').click();
  await page.keyboard.press('Control+End');
  await page.keyboard.type('<!-- last words -->');
  await page.getByLabel('File').selectOption('scenes/parts/metrics.xml');
  await page.getByRole('treeitem').filter({ hasText: 'part' }).first().waitFor(patience);
  await saved(page);
  await page.getByLabel('File').selectOption('scenes/training/1_sylvian_fissure.xml');
  await page.getByRole('treeitem').filter({ hasText: 'scene' }).first().waitFor(patience);
  await saved(page);
  assert.match(onDisk(copy), /<!-- last words -->$/);
  assert.equal(onDisk(part), partBefore);
  check('what was typed just before another file was opened is kept');

  await inTwoWindows(page);

  await lookAtIt(page);
  const seen = picture(page);
  await shot(page, 'live');
  const session = () => seen.evaluate(() => window.__insula.session ?? '');
  const first = await session();
  const pictures = () => seen.evaluate(() => window.__insula.pictures);
  const point = (of) => of.exec(onDisk(copy)).slice(1).map(Number);
  const box = await page.locator('.live iframe').boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down({ button: 'right' });
  await page.mouse.move(x + 40, y + 10, { steps: 4 });
  await page.mouse.up({ button: 'right' });
  await seen.waitForFunction((n) => window.__insula.pictures > n + 20, await pictures(), patience);
  await page.getByRole('button', { name: 'Take the present view' }).click();
  await waitFor('view in the text', () => !onDisk(copy).includes('eye="357 66 -25 mm"'));
  const [eye, target] = ['eye', 'target'].map((n) => point(new RegExp(`<view[^>]*${n}="(\\S+) (\\S+) (\\S+) mm"`)));
  const far = (a, b) => Math.hypot(...a.map((v, k) => v - b[k]));
  assert.ok(far(eye, [357, 66, -25]) > 10 && far(target, [65, 6, 1]) < 0.1, `${eye} to ${target}`);
  const distance = far([357, 66, -25], [65, 6, 1]);
  assert.ok(Math.abs(far(eye, target) - distance) < 1, 'it was turned, not moved');
  await seen.waitForFunction((before) => window.__insula?.ready && window.__insula.session !== before, first, patience);
  await shot(page, 'view_taken');
  assert.deepEqual(await axeFinds(page), []);
  check('the scene is looked at, its view is taken, and the picture is loaded again');

  await item(page, 'dissector', 'right_dissector').click();
  const home = () => point(/right_dissector[^]*?home="(\S+) (\S+) (\S+) mm"/);
  const before = home();
  await page.getByRole('button', { name: 'Place home with the mouse' }).click();
  await page.getByText('Drag an arrow or a square of the point.').waitFor(patience);
  await seen.waitForFunction(() => window.__insula.placing, null, patience);
  await shot(page, 'placing');
  const [ballX, ballY] = await seen.evaluate(() => window.__insula.placing);
  await page.mouse.move(box.x + ballX, box.y + ballY);
  await page.mouse.down();
  await page.mouse.move(box.x + ballX - 24, box.y + ballY - 12, { steps: 5 });
  await page.mouse.up();
  await waitFor('another home', () => home().join() !== before.join());
  const moved = Math.hypot(...home().map((c, k) => c - before[k]));
  assert.ok(moved > 0.5 && moved < 30, `${before} to ${home()}`);
  await shot(page, 'placed');
  check(`a tool's home is placed with the mouse, ${moved.toFixed(1)} mm away`);
  assert.equal(onDisk(shipped), original);
} finally {
  await browser.close();
  await programs.end();
  rmSync(data, { recursive: true, force: true });
}
