// SPDX-License-Identifier: GPL-3.0-or-later
// A scan is dropped onto the page of the case builder, with the real programs: slices and preview are shown, threshold
// and seed are chosen by keys and mouse, ends are cut by drawn lines, and the neck is found. Exit status 77: no browser
// or no programs, skipped. INSULA_PICTURES names a folder for the pictures of docs/tutorial-case.md.
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { axeFinds } from './axe.mjs';
import { check, launch, patience } from './browser.mjs';
import { ownBus, Programs } from './programs.mjs';
import { forkScan, forkSeries, scout } from './scan_bytes.mjs';
import { dropped, droppedFrom, picture, shots, step, viewport } from './studio_page.mjs';

const programs = new Programs();
const data = mkdtempSync(join(tmpdir(), 'insula_scan_'));
const bus = ownBus();
const person = 'Doe^Jane';

const shot = shots('scan');

/** Once the vessel of the present choices is found: its kept and other nodes, and its triangles. */
async function found(page) {
  await page.waitForFunction(() => window.__scan?.found() && !window.__scan.busy(), null, patience);
  return page.evaluate(() => {
    const { grid, triangles, ms } = window.__scan.found();
    const count = (mark) => grid.part.reduce((n, p) => n + (p === mark ? 1 : 0), 0);
    return { kept: count(1), others: count(2), triangles: triangles.length / 3, ms };
  });
}

/** The project, once it is as wanted. */
async function project(page, is = () => true) {
  for (const end = Date.now() + patience.timeout; ;) {
    const p = await page.evaluate(async () => (await fetch('api/studio/project?name=head_scan')).json());
    if (is(p)) return p;
    assert.ok(Date.now() < end, `no such project: ${JSON.stringify(p).slice(0, 3000)}`);
    await page.waitForTimeout(100);
  }
}

/** Once its surface is made with choices that are as wanted. */
async function surface(page, is = () => true) {
  const p = await project(page, (q) => is(q.choices) && !['running', 'waiting'].includes(q.inspect.state));
  assert.equal(p.inspect.state, 'done', JSON.stringify(p.inspect));
  return p;
}

/** A folder as a hospital's disc has it: two series, a list of files, and a text. */
function disc() {
  const folder = join(data, 'CD of Jane');
  mkdirSync(join(folder, 'IMAGES'), { recursive: true });
  forkSeries(person).forEach((image, k) => writeFileSync(join(folder, 'IMAGES', `${person}_${k}`), image));
  scout(person).forEach((image, k) => writeFileSync(join(folder, 'IMAGES', `IM${k}`), image));
  writeFileSync(join(folder, 'README.TXT'), 'Open with the viewer on this disc.');
  return folder;
}

/** No file of the project names the person. */
function namesNobody(project) {
  const folder = join(data, 'studio', project);
  for (const file of readdirSync(folder, { recursive: true, withFileTypes: true }))
    if (file.isFile()) assert.ok(!readFileSync(join(file.parentPath, file.name)).includes(person), file.name);
  assert.ok(!readdirSync(folder).includes('upload'));
}

const browser = await launch();
try {
  const studio = programs.start('insula', ['studio', '--no-browser', '--port', '0', '--data', data], bus);
  const { address } = await programs.told(studio, /studio is at (\S+)/);
  const page = await browser.newPage({ viewport });
  page.setDefaultTimeout(patience.timeout);
  await page.goto(address);
  await page.getByText('There are no projects yet.').waitFor(patience);

  await dropped(page, 'half.mha', Buffer.from('ObjectType = Image\nDimSize = 4 4 4\nElementDataFile = other.raw\n'));
  await page.getByText('this scan needs another file').waitFor(patience);
  check('a scan that names another file is refused');

  await droppedFrom(page, disc());
  const thin = page.getByRole('button', { name: '5 · CT · CTA thin · 72 images' });
  await thin.waitFor(patience);
  await page.getByRole('button', { name: '4 · CT · Scout · 2 images' }).waitFor(patience);
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'series');
  await picture(page, 'series');
  const network = await page.context().newCDPSession(page);
  const speed = (uploadThroughput) =>
    network.send('Network.emulateNetworkConditions', {
      offline: false,
      latency: 0,
      downloadThroughput: -1,
      uploadThroughput,
    });
  await network.send('Network.enable');
  await speed(30_000); // bytes a second
  await thin.click();
  await page.getByText('Sending CD of Jane.zip').waitFor(patience);
  await page.waitForFunction(() => document.querySelector('.drop progress').value > 0.1, null, patience);
  await page.getByRole('button', { name: 'Cancel' }).click();
  await page.getByText('Cancelled.').waitFor(patience);
  await speed(-1);
  assert.deepEqual(await page.evaluate(async () => (await (await fetch('api/studio/projects')).json()).projects), []);
  await page.locator('input[webkitdirectory]').setInputFiles(join(data, 'CD of Jane'));
  await thin.click();
  await page.getByText('96 × 96 × 72 voxels').waitFor(patience);
  await shot(page, 'folder');
  namesNobody('CD_of_Jane');
  check('a folder with DICOM series is dropped, one of them is chosen, sent, cancelled, and sent again');
  await page.getByRole('link', { name: 'All projects' }).click();

  const scan = forkScan();
  scan.write(person, 148, 'latin1'); // the description in the header of a NIfTI file
  await dropped(page, 'head scan.nii', scan);
  await page.getByText('96 × 96 × 72 voxels').waitFor(patience);
  const first = await found(page);
  assert.ok(first.kept > 3000 && first.triangles > 2000, JSON.stringify(first));
  assert.ok(first.others > 50, 'the speck of calcium is another piece');
  await page.waitForFunction(() => window.__scan.state.block.facts.threshold > 70, null, patience);
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'opened');
  await picture(page, 'scan', step(page, 'The vessel in the scan'));
  check(
    `a dropped scan is shown with ${first.triangles} triangles of the proposed threshold, in ${first.ms.toFixed(0)} ms`,
  );

  namesNobody('head_scan');
  check('no file of the project names the person of the scan');

  const slider = page.getByLabel('Threshold: vessel from this value up');
  await slider.focus();
  const before = await page.evaluate(() => window.__scan.state.threshold);
  for (let k = 0; k < 20; k++) await page.keyboard.press('ArrowRight');
  const after = await page.evaluate(() => window.__scan.state.threshold);
  assert.ok(after > before, `${before} to ${after}`);
  let p = await surface(page, (c) => c.threshold !== null && Math.abs(c.threshold - after) < 1);
  assert.match(p.command, /--threshold/);
  await page.getByText('Three methods agree').waitFor(patience); // the page has grown
  const box = await slider.boundingBox();
  await slider.click({ position: { x: 0.93 * box.width, y: box.height / 2 } });
  const high = await found(page);
  assert.ok(high.kept < first.kept / 10, 'only the calcium is so bright');
  await project(page, (q) => q.choices.threshold > after + 100);
  await page.keyboard.press('Control+z');
  await page.waitForFunction((t) => Math.abs(window.__scan.state.threshold - t) < 2, after, patience);
  check('the threshold is moved by keys and mouse, and taken back');

  // The seed: by clicks into the slices, at the speck of calcium.
  const axial = page.getByRole('slider', { name: 'Axial slice' });
  const slices = Number(await axial.getAttribute('aria-valuemax'));
  assert.equal(slices, 72);
  await axial.focus();
  const middle = Number(await axial.getAttribute('aria-valuenow'));
  for (let k = 0; k < 20; k++) await page.keyboard.press('ArrowDown');
  await page.waitForFunction(
    (n) => Number(document.querySelector('.scan canvas').getAttribute('aria-valuenow')) === n,
    middle - 20,
    patience,
  );
  const image = await axial.boundingBox();
  const scale = Math.min(image.width, image.height) / 38.4;
  await page.mouse.click(image.x + image.width / 2 + 12 * scale, image.y + image.height / 2 + 12 * scale);
  const cross = await page.evaluate(() => window.__scan.state.block.world(window.__scan.state.cross));
  assert.ok(Math.hypot(cross[0] + 12, cross[1] + 12, cross[2] + 8) < 1, `crosshair at ${cross}`);
  await page.getByRole('button', { name: 'Put the seed at the crosshair' }).click();
  await page.getByText('Only what is connected with it is kept').waitFor(patience);
  const speck = await found(page);
  assert.ok(speck.kept < first.others * 1.2 && speck.others > 3000, JSON.stringify(speck));
  await shot(page, 'speck');
  await page.getByRole('button', { name: 'Remove the seed' }).click();
  await page.getByText('the largest connected piece is kept').waitFor(patience);
  check('a seed keeps its piece only');
  p = await surface(page, (c) => c.seed === null);
  assert.ok(p.inspect.facts.size_mm[0] > 25, JSON.stringify(p.inspect.facts.size_mm));
  assert.equal(p.inspect.facts.problem, '', 'its round ends were cut');
  assert.equal(p.inspect.facts.openings.length, 3);

  // A bridge from the parent to the speck is painted with the brush, and taken back.
  await page.getByLabel('A drag in a slice').selectOption('paint');
  const whole = await found(page);
  await axial.focus();
  for (let k = 0; k < 20; k++) await page.keyboard.press('ArrowUp');
  const there = await axial.boundingBox(); // the page may have scrolled
  const at = (x, y) => [there.x + there.width / 2 - x * scale, there.y + there.height / 2 - y * scale];
  await page.mouse.move(...at(-5, 0));
  await page.mouse.down();
  for (let y = 0; y >= -8; y -= 2) await page.mouse.move(...at(-5, y));
  await page.mouse.up();
  p = await surface(page, (c) => c.paint.length === 1);
  await page.waitForFunction(() => window.__scan.state.paint.length === 1, null, patience);
  const bridged = await found(page);
  assert.ok(bridged.kept > whole.kept + 200, `${bridged.kept} after ${whole.kept}`);
  assert.ok(p.inspect.facts.size_mm[1] > 21, `the branch and the stroke span ${p.inspect.facts.size_mm[1]} mm`);
  await shot(page, 'painted');
  await picture(page, 'brush', step(page, 'By hand'));
  await page.getByRole('button', { name: 'Undo' }).click();
  await surface(page, (c) => c.paint.length === 0);
  await page.waitForFunction(() => window.__scan.state.paint.length === 0, null, patience);
  assert.equal((await found(page)).kept, whole.kept);
  check('what is missing is painted with a brush, and taken back');

  await page.getByRole('button', { name: 'Surface', exact: true }).click();
  await page.waitForFunction(() => window.__studio.ready(), null, patience);
  await page.waitForTimeout(500);
  // Turned by an eighth, all ends are seen from the side.
  const view = await page.locator('.view canvas').boundingBox();
  const [vx, vy] = [view.x + view.width / 2, view.y + view.height - 30];
  await page.mouse.move(vx, vy);
  await page.mouse.down();
  await page.mouse.move(vx + view.height / 8, vy, { steps: 4 });
  await page.mouse.up();
  await shot(page, 'surface');
  for (const [k, end] of [
    [-11, 0, 0],
    [11, 0, 0],
    [3, 11, 0],
  ].entries()) {
    await page.getByRole('button', { name: 'Cut an end' }).click();
    const line = await page.evaluate((at) => {
      // Across the vessel, which goes from the middle to this end.
      const [a, b] = [at.map((x) => 0.9 * x), at].map((q) => window.__studio.screenOf(q));
      const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
      const [l, half] = [Math.hypot(dx, dy), 45];
      return [-1, 1].map((s) => [b[0] - (s * half * dy) / l, b[1] + (s * half * dx) / l]);
    }, end);
    await page.mouse.move(...line[0]);
    await page.mouse.down();
    await page.mouse.move((line[0][0] + line[1][0]) / 2, (line[0][1] + line[1][1]) / 2);
    await page.mouse.move(...line[1]);
    await page.mouse.up();
    await page.getByRole('button', { name: 'Cut', exact: true }).waitFor(patience);
    await shot(page, `cut_${k}`);
    if (k === 1) await picture(page, 'cut', step(page, 'Ends of the vessel'));
    await page.getByRole('button', { name: 'Cut', exact: true }).click();
    p = await surface(page, (c) => c.cuts.length === k + 1);
    assert.equal(p.inspect.facts.openings.length, 3, JSON.stringify(p.inspect.facts.openings));
    await page.waitForTimeout(700);
  }
  assert.deepEqual(await axeFinds(page), []);
  const { openings, neck } = p.inspect.facts;
  const ends = openings.map((o) => o.centre.map((x) => Math.round(x)));
  assert.ok(ends.some(([x]) => x < -9) && ends.some(([x]) => x > 9) && ends.some(([, y]) => y > 9), String(ends));
  await page.getByText('Three methods agree').waitFor(patience);
  const [x, y, z] = neck.proposals[0].centre;
  assert.ok(Math.hypot(x, y) < 1.5 && z > 0.5 && z < 4, `neck at ${neck.proposals[0].centre}`);
  await shot(page, 'cut');
  check('three ends are cut by drawn lines, and the neck is found');

  await page.getByRole('button', { name: 'Undo' }).click();
  await surface(page, (c) => c.cuts.length === 2);
  check('a cut is taken back');

  await page.getByRole('button', { name: 'Redo' }).click();
  await surface(page, (c) => c.cuts.length === 3);
  await page.getByLabel('Play the exercises until scripted hands succeed').uncheck();
  await page.getByRole('button', { name: 'Build', exact: true }).click();
  p = await project(page, (q) => q.build.state !== 'running' && q.build.state !== '');
  assert.equal(p.build.state, 'done', p.build.error);
  await page.locator('[data-exercise="3_clipping.xml"]').waitFor(patience);
  await shot(page, 'built');
  assert.match(p.built.report.neck ? String(p.built.report.neck.diameter_mm) : '', /^[2-6]\.?\d*$/);
  check(`the case is built from the scan, with a neck of ${p.built.report.neck.diameter_mm} mm`);
} finally {
  await browser.close();
  await programs.end();
  rmSync(data, { recursive: true, force: true });
}
