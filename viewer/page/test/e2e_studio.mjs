// SPDX-License-Identifier: GPL-3.0-or-later
// A case is made on the page of the case builder, with the real programs: a surface is dropped, the neck is set by
// clicks, the case is built, builder and gateway are killed in between, and the exercise is played. Exit status 77: no
// browser or no programs, skipped. INSULA_PICTURES names a folder for the pictures of docs/tutorial-case.md.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { axeFinds } from './axe.mjs';
import { check, launch, patience, waitFor } from './browser.mjs';
import { ownBus, Programs, root } from './programs.mjs';
import { addARetractor, moveTheVessel, paintAPlaque, project } from './studio_deeds.mjs';
import { goalsAndStrands } from './studio_forms.mjs';
import { childrenOf, gatewayBelow } from './studio_processes.mjs';
import { dropped, picture, shots, step, viewport } from './studio_page.mjs';
import { removedElsewhere, twoWindows } from './studio_windows.mjs';

const programs = new Programs();
const data = mkdtempSync(join(tmpdir(), 'insula_studio_'));
const surface = readFileSync(join(root, 'meshes/arteries/narrow_neck/wall.ply'));
const bus = ownBus();

const shot = shots('studio');

/** Two points of the wall on opposite sides of the proposed neck, as they lie on the page. */
async function sidesOfNeck(page, { centre, normal, diameter_mm: width }) {
  return page.evaluate(
    ({ c, n, w }) => {
      const at = (p) => window.__studio.screenOf(p);
      // Across the neck, and as far across the view as the plane admits.
      const helper = Math.abs(n[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0];
      const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
      const unit = (v) => v.map((x) => x / Math.hypot(...v));
      const u = unit(cross(n, helper));
      const v = cross(n, u);
      let best = null;
      for (let k = 0; k < 36; k++) {
        const [x, y] = [Math.cos((k * Math.PI) / 18), Math.sin((k * Math.PI) / 18)];
        const side = u.map((ui, i) => x * ui + y * v[i]);
        const ends = [-0.42, 0.42].map((s) => at(c.map((ci, i) => ci + s * w * side[i])));
        const apart = Math.hypot(ends[0][0] - ends[1][0], ends[0][1] - ends[1][1]);
        if (!best || apart > best.apart) best = { apart, ends };
      }
      return best.ends;
    },
    { c: centre, n: normal, w: width },
  );
}

/** The gateway has all of a file, its answer is late, and the author presses Cancel. */
async function cancelledAtTheEnd(page) {
  const names = () => page.evaluate(async () => (await (await fetch('api/studio/projects')).json()).projects.length);
  let arrived = 0;
  await page.route('**/api/studio/upload?*', async (route) => {
    const answer = await route.fetch();
    arrived = await names();
    await page.getByRole('button', { name: 'Cancel' }).click();
    await route.fulfill({ response: answer }).catch(() => undefined); // nobody waits for it any more
  });
  await dropped(page, 'narrow neck.ply', surface);
  await page.getByText('Cancelled.').waitFor(patience);
  await waitFor('no project', async () => arrived === 1 && (await names()) === 0);
  await page.unroute('**/api/studio/upload?*');
}

/** The clipping as a trainee begins it, drawn well. */
async function pictureOfTheField(page) {
  if (!process.env.INSULA_PICTURES) return;
  await page.setViewportSize(viewport);
  await page.goto(`${page.url()}${page.url().includes('?') ? '&' : '?'}quality=medium`);
  await page.waitForFunction(() => window.__insula?.ready, null, patience);
  await page.getByRole('button', { name: /^Try/ }).click();
  for (const name of ['Not now', '✓ Read']) await page.getByRole('button', { name }).click();
  await page.waitForTimeout(8000); // the picture becomes sharp
  await picture(page, 'play');
}

let studio;
const start = async () => {
  studio = programs.start('insula', ['studio', '--no-browser', '--port', '0', '--data', data], bus);
  return programs.told(studio, /studio is at (\S+)/);
};

const browser = await launch();
try {
  let { address } = await start();
  const page = await browser.newPage({ viewport });
  page.setDefaultTimeout(patience.timeout);
  await page.goto(address);
  await page.getByText('There are no projects yet.').waitFor(patience);
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'empty');
  await picture(page, 'drop');

  await dropped(page, 'picture.stl', Buffer.from('\x89PNG\r\n\x1a\n'));
  await page.getByText('this file is no surface').waitFor(patience);
  check('a file that is no surface is refused, whatever its name says');

  await cancelledAtTheEnd(page);
  check('a file that is cancelled after all of it has arrived leaves no project');

  await dropped(page, 'narrow neck.ply', surface);
  await page.getByText('Three methods agree').waitFor(patience);
  await page.waitForFunction(() => window.__studio.ready(), null, patience);
  const before = await project(page, 'narrow_neck');
  const { facts } = before.inspect;
  assert.ok(facts.openings.length >= 3 && facts.triangles_given > 3000, JSON.stringify(facts).slice(0, 300));
  assert.match(await page.locator('.steps').innerText(), /3,276 triangles[^]*openings/);
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'surface');
  await picture(page, 'surface');
  check('a dropped surface is shown with its openings and the proposed neck');

  const proposal = facts.neck.proposals[0];
  await page.getByRole('button', { name: 'Set the neck by clicks' }).click();
  for (const [x, y] of await sidesOfNeck(page, proposal)) await page.mouse.click(x, y);
  await page.getByText('set by clicks', { exact: true }).waitFor(patience);
  const { neck } = (await project(page, 'narrow_neck')).choices;
  const width = Math.hypot(...[0, 1, 2].map((k) => neck.points[k] - neck.points[k + 3]));
  assert.ok(width > 0.4 * proposal.diameter_mm && width < 1.6 * proposal.diameter_mm, `${width} mm between the clicks`);
  await shot(page, 'neck');
  await picture(page, 'neck', step(page, '2. The neck'));
  check(`the neck is set by two clicks, ${width.toFixed(1)} mm apart`);

  await page.getByRole('button', { name: 'Undo' }).click();
  await page.waitForFunction(() => document.querySelector('input[name=neck]').checked, null, patience);
  await page.getByRole('button', { name: 'Redo' }).click();
  await page.getByText('set by clicks', { exact: true }).waitFor(patience);
  check('a choice is undone and made again');

  const seen = await twoWindows(page, address);
  check(`a second window shows a change after ${seen.toFixed(1)} s, and overwrites none that it has not seen`);

  const places = await paintAPlaque(page, proposal);
  check(`a part of the wall is painted with ${places} points, undone and made stiffer`);

  // The clipping trial takes minutes.
  await page.getByLabel('Play the exercises until scripted hands succeed').uncheck();
  await waitFor('choice', async () => !(await project(page, 'narrow_neck')).choices.rehearse);
  const chosen = (await project(page, 'narrow_neck')).choices;
  await page.getByRole('button', { name: 'Build', exact: true }).click();
  await page.locator('.stages .now').waitFor(patience);
  await waitFor('builder', () => childrenOf(gatewayBelow(studio.pid)).length > 0);
  process.kill(childrenOf(gatewayBelow(studio.pid))[0], 'SIGKILL');
  await page.getByText(/signal 9 .*nothing of your project is lost/).waitFor(patience);
  await shot(page, 'killed');
  check('a builder that is killed is told of');

  await page.getByRole('button', { name: 'Build', exact: true }).click();
  await waitFor('builder', () => childrenOf(gatewayBelow(studio.pid)).length > 0);
  const orphan = childrenOf(gatewayBelow(studio.pid))[0];
  programs.mayEnd(studio);
  const [gateway, supervisor] = [gatewayBelow(studio.pid), studio.pid];
  process.kill(supervisor, 'SIGKILL');
  process.kill(gateway, 'SIGKILL');
  await waitFor('end of the builder', () => !childrenOf(1).includes(orphan) && !childrenOf(gateway).includes(orphan));
  ({ address } = await start());
  await page.goto(`${address}#narrow_neck`);
  await page.getByText('The build was interrupted').waitFor(patience);
  assert.deepEqual((await project(page, 'narrow_neck')).choices, chosen);
  check('a gateway that is killed loses nothing');

  const began = performance.now();
  await page.getByRole('button', { name: 'Build', exact: true }).click();
  await page.locator('.stages .now').waitFor(patience);
  await shot(page, 'building');
  await picture(page, 'building', step(page, '3. The case'));
  await page.getByText('5. The result').waitFor(patience);
  const seconds = ((performance.now() - began) / 1000).toFixed(0);
  const result = await page.locator('.result').innerText();
  assert.match(result, /Neck\s+\d\.\d+ mm wide[^]*Time of a step\s+[\d.]+ ms of [\d.]+ ms/);
  await page.waitForFunction(
    () => [...document.querySelectorAll('.pictures img')].every((i) => i.complete && i.naturalWidth > 0),
    null,
    patience,
  );
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'result');
  await picture(page, 'result', step(page, '5. The result'));
  check(`the case is built in ${seconds} s and its report shown`);

  await goalsAndStrands(page);
  const stiffness = page.getByRole('group', { name: 'Neck' }).getByLabel('Stiffness (Young’s modulus)');
  await stiffness.fill('2 kg');
  await page.locator('[id="wall-neck-young-about"].bad').waitFor(patience);
  await stiffness.fill('7');
  await stiffness.press('Tab');
  await waitFor('stiff neck', async () => (await project(page, 'narrow_neck')).choices.walls[0] === 'neck.young=7 MPa');
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'walls');
  const { moved, mm } = await moveTheVessel(page);
  check(`the vessel is moved by ${mm.toFixed(2)} mm, with its overlap and the sight of its neck`);
  const added = await addARetractor(page);
  check(`a retractor is added, moved by ${added.mm.toFixed(2)} mm and removed, and all is undone`);
  await page.getByRole('button', { name: 'Build', exact: true }).click();
  await page.locator('.stages .now').waitFor(patience);
  await page.getByText('Choices have changed since: build again.').waitFor({ state: 'hidden', ...patience });
  const { built } = await project(page, 'narrow_neck');
  const text = readFileSync(join(data, 'studio/narrow_neck', built.number, 'narrow_neck/3_clipping.xml'), 'utf8');
  assert.match(text, /max_grade="1"/);
  assert.doesNotMatch(text, /<time_limit/);
  const tied = readFileSync(
    join(data, 'studio/narrow_neck', built.number, 'narrow_neck/2_aneurysm_dissection.xml'),
    'utf8',
  );
  assert.match(tied, /id="to_frontal"[^>]*density="30 1\/cm2"[^>]*stiffness="80 N\/m"/);
  const wall = readFileSync(join(data, 'studio/narrow_neck', built.number, 'narrow_neck/artery.xml'), 'utf8');
  assert.match(wall, /regions="neck" thickness="[0-9.]+ mm" young="7 MPa"/);
  assert.match(wall, /id="wall_patch_1" spots="[^"]* mm; [^"]*" spot_radius="1 mm" thickness="0.5 mm" young="8 MPa"/);
  const arms = readFileSync(join(data, 'studio/narrow_neck', built.number, 'narrow_neck/retractors.xml'), 'utf8');
  const way = /id="arm_2"[^>]*approach="([^"]*) mm"/.exec(arms)[1].split(' ').map(Number);
  assert.ok(Math.abs(Math.hypot(...way) - added.retractor.pull_mm) < 0.01, `${way}`);
  const place = readFileSync(join(data, 'studio/narrow_neck', built.number, 'narrow_neck/place.json'), 'utf8');
  const shift = JSON.parse(place).shift_mm;
  assert.ok(Math.hypot(...shift.map((x, k) => x - moved[k])) < 0.01, `${shift}: ${moved}`);
  check('the painted part, the place and the retractors are built');
  check('a goal, a limit, strands and the stiffness of the neck are changed by forms, and built');

  await page.locator('.clip select').selectOption('angled_60_6');
  await page.getByLabel('Higher over the neck, mm').fill('-0.5');
  await page.getByLabel('Higher over the neck, mm').press('Tab');
  const clipped = () =>
    waitFor('clip', async () => {
      const { choices } = await project(page, 'narrow_neck');
      return choices.clip === 'angled_60_6' && choices.lift_mm === -0.5;
    });
  await clipped();
  await page.getByRole('button', { name: 'Close this clip' }).click();
  await page.getByText('The clip is being closed …').waitFor(patience);
  await page.getByText('Neck left open').waitFor(patience);
  const { trial, command } = await project(page, 'narrow_neck');
  assert.equal(trial.found.clip, 'angled_60_6');
  assert.equal(trial.found.lift_mm, -0.5);
  assert.ok(Object.keys(trial.found.flows_pct).length === 2, JSON.stringify(trial));
  const away = trial.found.blades.flat().map((q) => Math.hypot(...q.map((x, k) => x - proposal.centre[k])));
  assert.ok(Math.min(...away) < 9, `the blades are ${away} mm from the neck`);
  assert.match(command, /--clip angled_60_6 --lift "-0.5 mm"/);
  assert.deepEqual(await axeFinds(page), []);
  await shot(page, 'clip');
  await picture(page, 'clip', step(page, '7. Try a clip'));
  await page.getByRole('button', { name: 'As proposed', exact: true }).click();
  await page.getByText('Tried with other choices: close the clip again.').waitFor(patience);
  await page.getByRole('button', { name: 'Undo' }).click();
  await clipped();
  check(`a clip is closed over the neck: ${Math.round(trial.found.remnant_pct)} % of it are left open`);

  const [played] = await Promise.all([
    page.waitForEvent('popup'),
    page.locator('[data-exercise="3_clipping.xml"]').click(),
  ]);
  await played.waitForURL(/^http/, patience);
  await played.waitForFunction(() => window.__insula?.ready, null, patience);
  await shot(played, 'played');
  await pictureOfTheField(played);
  const cases = programs.insula(['cases', '--data', data]);
  assert.match(cases, /narrow_neck\s.*4 exercises, added/);
  check('the case is added, and its exercise opens');
  await played.close();
  await removedElsewhere(page, address);
  check('a window whose case was removed in another one says so');
} finally {
  await browser.close();
  await programs.end();
  rmSync(data, { recursive: true, force: true });
}
