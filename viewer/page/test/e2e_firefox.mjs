// SPDX-License-Identifier: GPL-3.0-or-later
// The real programs in Firefox. From first use to certificate with no terminal, with a look at a live exercise on the
// way, all by TLS; axe looks at each page of the way. Then the start page by keys alone, and a login by PIN as from
// another machine. Exit status 77: no Firefox or no screen for it, no programs or no multicast, skipped.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { axeFinds } from './axe.mjs';
import { check, patience } from './browser.mjs';
import { launchFirefox } from './firefox.mjs';
import { liveExercise } from './first_use/live.mjs';
import { FirstUse, shot, walkToCertificate } from './first_use/walk.mjs';
import { gatewayFromElsewhere } from './from_elsewhere.mjs';
import { gatewayProgram } from './programs.mjs';

/** A page that has WebGL 2: Firefox and its screen are here, so it must. */
async function newPage(browser) {
  const page = await browser.newPage({ viewport: { width: 1366, height: 768 }, ignoreHTTPSErrors: true });
  const drawnBy = await page.evaluate(() => {
    const context = document.createElement('canvas').getContext('webgl2');
    return context && context.getParameter(context.RENDERER);
  });
  assert.ok(drawnBy, 'WebGL 2 comes up');
  check(`Firefox ${browser.version()} draws by WebGL 2 (${drawnBy})`);
  return page;
}

/** What axe finds, by page. */
const broken = [];
async function accessible(page, where) {
  for (const what of await axeFinds(page)) broken.push(`${where}: ${what}`);
}

const focused = (page) => page.evaluate(() => document.activeElement.textContent.trim());

/** Tab until a thing with that text has the focus, which is seen. */
async function tabTo(page, words) {
  for (let k = 0; k < 60; k++) {
    await page.keyboard.press('Tab');
    if ((await focused(page)) !== words) continue;
    const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
    return assert.notEqual(outline, 'none', `the focus on ${words} is seen`);
  }
  assert.fail(`no way to ${words} by keys`);
}

async function startByKeys(page, { address }) {
  await page.goto(address);
  await page.waitForSelector('.card', patience);
  await tabTo(page, 'Settings');
  await page.keyboard.press('Enter');
  await page.waitForSelector('dialog.settings[open]', patience);
  await accessible(page, 'settings');
  // Not as far as the dialog's last button: after it come the browser's own ones, whence no key reaches the page.
  for (let k = 0; k < 4; k++) {
    await page.keyboard.press('Tab');
    const inside = await page.evaluate(() => document.activeElement.closest('body > *, dialog[open]')?.tagName);
    assert.ok(inside === undefined || inside === 'DIALOG', 'the focus stays in the dialog');
  }
  await page.keyboard.press('Escape');
  await page.waitForSelector('dialog.settings', { ...patience, state: 'hidden' });
  assert.equal(await focused(page), 'Settings', 'the focus comes back');
  check('the settings are opened, walked through and closed by keys alone');
}

async function logIn(browser) {
  const folder = mkdtempSync(join(tmpdir(), 'insula_pin_'));
  const pins = join(folder, 'pins');
  writeFileSync(pins, JSON.stringify({ pin: '123456', observer_pin: '654321' }), { mode: 0o600 });
  const station = await gatewayFromElsewhere(folder, gatewayProgram, ['--pins', pins, '--no-mdns']);
  if (!station) return console.log('left out: a login, since this machine allows no network of its own');
  try {
    const page = await browser.newPage({ viewport: { width: 1366, height: 768 } });
    await page.goto(station.address);
    await page.waitForSelector('#pin', patience);
    await accessible(page, 'login');
    await page.keyboard.type('111111');
    await page.keyboard.press('Enter');
    await page.getByText('This is not the PIN.').waitFor(patience);
    await page.keyboard.type('123456');
    await page.keyboard.press('Enter');
    await page.waitForURL(/index\.html|\/$/, patience);
    const access = () => page.evaluate(async () => (await (await fetch('api/login')).json()).access);
    assert.equal(await access(), 'instructor');
    await page.reload();
    assert.equal(await access(), 'instructor');
    check('a wrong PIN is refused, the right one admits as instructor and stays');
  } finally {
    await station.end();
    rmSync(folder, { recursive: true, force: true });
  }
}

const browser = await launchFirefox();
const place = await new FirstUse().open('--tls');
place.visited = async (page, name) => {
  await shot(page, name);
  await accessible(page, name);
};
try {
  const page = await newPage(browser);
  const errors = [];
  page.on('pageerror', (e) => errors.push(e.message));
  await walkToCertificate(page, place, liveExercise);
  await startByKeys(page, place);
  await logIn(browser);
  assert.deepEqual(errors, []);
  assert.equal(broken.join('\n'), '');
  check('axe finds nothing against WCAG 2 A and AA on the pages of the way');
} finally {
  await browser.close();
  await place.end();
}
