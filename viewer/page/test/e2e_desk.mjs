// SPDX-License-Identifier: GPL-3.0-or-later
// `insula room` opens the overview without a session, and an instructor makes PINs and the key of the room there, by
// keys only. Exit status 77: no browser or no programs, skipped.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { check, launch, patience } from './browser.mjs';
import { Programs } from './programs.mjs';

const programs = new Programs();
const folder = mkdtempSync(join(tmpdir(), 'insula_desk_'));
const words = ['room', '--no-browser', '--no-mdns', '--port', '0', '--data', folder];

/** The address that `insula room` prints. */
function overview() {
  const child = programs.start('insula', words, 'memq://');
  return new Promise((resolve, reject) => {
    let said = '';
    for (const out of [child.stdout, child.stderr])
      out.on('data', (d) => {
        said += d;
        const found = /the room is at (\S+)/.exec(said);
        if (found) resolve({ child, url: found[1] });
      });
    child.once('exit', (status) => reject(new Error(`insula room ended with ${status}: ${said}`)));
  });
}

const errors = [];

async function openOverview(browser, url) {
  const page = await browser.newPage({ viewport: { width: 1024, height: 768 } });
  page.on('pageerror', (e) => errors.push(e.message));
  await page.goto(url);
  await page.getByText('No stations are listed yet.').waitFor(patience);
  return page;
}

/** Presses the tabulator until a thing with that text has the focus, then Enter. */
async function press(page, name) {
  for (let k = 0; k < 30; k++) {
    await page.keyboard.press('Tab');
    if ((await page.evaluate(() => document.activeElement?.textContent)) === name) return page.keyboard.press('Enter');
  }
  assert.fail(`no way to ${name} by keys`);
}

const dialog = (page) => page.locator('dialog[open]');

async function makeAll(page) {
  await page.getByRole('button', { name: 'PINs and key' }).waitFor(patience);
  await press(page, 'PINs and key');
  await dialog(page).getByText('There are none.').waitFor(patience);
  await press(page, 'Make PINs');
  await dialog(page)
    .getByText(/Instructors: \d{6}$/)
    .waitFor(patience);
  await dialog(page)
    .getByText(/Observers: \d{6}$/)
    .waitFor(patience);
  await dialog(page)
    .getByText(/until this program ends/)
    .waitFor(patience);
  await press(page, 'Make a key');
  await page.waitForFunction(() => document.activeElement?.textContent === 'Show the key', null, patience);
  await page.keyboard.press('Enter');
  const key = await dialog(page).locator('code').innerText();
  assert.match(key, /^[0-9a-f]{64}$/);
  return key;
}

const browser = await launch();
try {
  const first = await overview();
  const page = await openOverview(browser, first.url);
  const key = await makeAll(page);
  const file = join(folder, 'room_key');
  assert.equal(readFileSync(file, 'utf8'), `${key}\n`);
  assert.equal(statSync(file).mode & 0o777, 0o600);
  check('PINs and a key are made by keys, and only their owner may read the file of the key');

  await page.keyboard.press('Escape');
  assert.equal(await dialog(page).count(), 0);
  await page.close();
  first.child.removeAllListeners('exit');
  const ended = new Promise((resolve) => first.child.once('exit', resolve));
  first.child.kill('SIGINT');
  assert.equal(await ended, 0);
  const again = await openOverview(browser, (await overview()).url);
  await again.getByRole('button', { name: 'PINs and key' }).click();
  await dialog(again).getByText('There are none.').waitFor(patience);
  await dialog(again).getByText('Show the key').click();
  assert.equal(await dialog(again).locator('code').innerText(), key);
  const other = 'k'.repeat(40);
  await dialog(again).getByLabel('Key of another station of the room').fill('short');
  await again.keyboard.press('Enter');
  await dialog(again).getByText('a key is one line of 32 to 128 letters').waitFor(patience);
  await dialog(again).getByLabel('Key of another station of the room').fill(other);
  await again.keyboard.press('Enter');
  await again.waitForFunction((k) => document.querySelector('.secrets code')?.textContent === k, other, patience);
  check('the key is there at the next start, and that of another station takes its place');
  assert.deepEqual(errors, []);
} finally {
  await browser.close();
  programs.end();
  rmSync(folder, { recursive: true, force: true });
}
