// SPDX-License-Identifier: GPL-3.0-or-later
// The built page in headless Chromium (software rendering) against the mock server: it becomes ready, frames come in,
// the canvas shows something, pause and reset reach the server, a hand is taken without a jump, and it comes back by
// itself after the server was away. CHROMIUM names the browser when it is not /usr/bin/chromium. Exit status 77: no
// browser, skipped.
import assert from 'node:assert/strict';
import { startMock } from '../scripts/mock-server.mjs';
import { check, click, launch, look, patience, waitFor } from './browser.mjs';

let mock = await startMock({ port: 0, startS: 3 });
const port = Number(new URL(mock.url).port);
const browser = await launch();
const errors = [];
let away = false;
try {
  const page = await browser.newPage({ viewport: { width: 480, height: 320 } });
  page.on('console', (m) => {
    if (m.type() === 'error' && !away) errors.push(m.text());
  });
  page.on('pageerror', (e) => errors.push(e.message));
  const status = () => page.evaluate(() => ({ ...window.__insula }));

  await page.goto(`${mock.url}?quality=low`);
  await page.waitForFunction(() => window.__insula?.ready, null, patience);
  check('page is ready');
  const before = await status();
  await page.waitForFunction(
    (n) => window.__insula.frames > n + 20 && window.__insula.pictures > 3,
    before.frames,
    patience,
  );
  assert.equal((await status()).refused, 0);
  check('frames and pictures go on');

  assert.match(await page.textContent('.toast.advice'), /software.*hardware acceleration/i);
  await click(page, '.toast.advice button');
  await page.waitForFunction(() => !document.querySelector('.toast.advice'), null, patience);
  check('it says that pictures are drawn by software and what to do, until that has been read');

  const clip = { x: 140, y: 60, width: 200, height: 200 };
  const seen = await look(page, clip);
  assert.ok(seen.mean > 25 && seen.mean < 230, `mean brightness ${seen.mean}`);
  assert.ok(seen.deviation > 15, `contrast ${seen.deviation}`);
  assert.ok(seen.red > 0.2, `share of reddish pixels ${seen.red}`);
  check(
    `canvas shows tissue (brightness ${seen.mean.toFixed(0)}, contrast ${seen.deviation.toFixed(0)}, ` +
      `reddish ${(100 * seen.red).toFixed(0)} %)`,
  );

  const depth = () => page.textContent('.hand.active .depth');
  await waitFor('the distance of the tip in words', async () => /tip (\d+\.\d mm|contact)/.test(await depth()));
  await page.keyboard.press('k');
  await page.waitForFunction(() => window.__insula.ruler_mm !== null, null, patience);
  await waitFor('the ruler and the gauge in words', async () => /ruler .* mm · tips .* apart/.test(await depth()));
  await page.keyboard.press('k');
  await page.keyboard.press('k');
  await page.waitForFunction(() => window.__insula.ruler_mm === null, null, patience);
  check('at the lowest quality the depth of the tip is shown, and a key puts the ruler there and takes it away');

  // The scene stands still, so that a picture before and one after show the same moment. Ten pictures lie between two
  // looks, since a slow machine draws none between looks in a row. Torn membranes still fade.
  mock.state.frozen = true;
  let settled = seen;
  await waitFor('picture like the one before', async () => {
    const last = settled;
    const { pictures } = await status();
    await page.waitForFunction((n) => window.__insula.pictures > n + 10, pictures, patience);
    settled = await look(page, clip);
    return Math.abs(settled.mean - last.mean) <= 0.01 * last.mean;
  });
  const whole = await status();
  // The extension is asked for beforehand: a lost context gives none.
  await page.evaluate(() => {
    window.__card = document.getElementById('view').getContext('webgl2').getExtension('WEBGL_lose_context');
    window.__card.loseContext();
  });
  const banner = (text) =>
    page.waitForFunction(
      (t) =>
        (document.querySelector('.banner')?.textContent ?? '').startsWith(t) &&
        (t !== '' || document.querySelector('.banner').hidden),
      text,
      patience,
    );
  await page.waitForFunction(() => window.__insula.graphics_lost, null, patience);
  await banner('The graphics card was reset');
  const lost = await status();
  await page.waitForFunction((n) => window.__insula.frames > n + 20, lost.frames, patience);
  const dark = await look(page, clip);
  assert.equal((await status()).pictures, lost.pictures, 'no picture is counted that nobody sees');
  assert.ok(
    dark.red < 0.02 && dark.deviation < 5,
    `nothing is drawn meanwhile: reddish ${dark.red}, contrast ${dark.deviation}`,
  );
  await page.evaluate(() => window.__card.restoreContext());
  await page.waitForFunction(
    (n) => !window.__insula.graphics_lost && window.__insula.pictures > n + 3,
    lost.pictures,
    patience,
  );
  await banner('');
  const again = await look(page, clip);
  assert.ok(
    Math.abs(again.mean - settled.mean) < 0.08 * settled.mean &&
      Math.abs(again.deviation - settled.deviation) < 0.1 * settled.deviation &&
      Math.abs(again.red - settled.red) < 0.05,
    `the picture is as before: brightness ${settled.mean} -> ${again.mean}, ` +
      `contrast ${settled.deviation} -> ${again.deviation}, reddish ${settled.red} -> ${again.red}`,
  );
  mock.state.frozen = false;
  const { session: sessionNow, connected } = await status();
  assert.deepEqual([sessionNow, connected], [whole.session, true], 'the same session, without a reload');
  check('it says that the graphics card was reset, and draws the same again when it is back, without a reload');

  await page.keyboard.press('p');
  await waitFor('pause', () => mock.state.commands.includes('pause'));
  await page.waitForFunction(() => document.querySelector('.banner')?.textContent === 'Paused', null, patience);
  await page.keyboard.press('p');
  await waitFor('resume', () => mock.state.commands.includes('resume'));
  check('pause and resume reach the engine');

  const patient = page.getByRole('button', { name: 'Patient and exercise' });
  await patient.click(); // on a narrow screen
  const asks = page.locator('.requests');
  await asks.locator('summary').click();
  assert.deepEqual(await asks.locator('button').allTextContents(), ['give adenosine'], 'no command of the instructor');
  const dose = asks.getByRole('spinbutton');
  assert.equal(await dose.inputValue(), '25', 'the usual one');
  await dose.click({ clickCount: 3 });
  await page.keyboard.type('30');
  await asks.getByRole('button').click();
  await waitFor('the dose', () => mock.state.commands.includes('ask adenosine give_adenosine 30'));
  await asks.getByText(/^done at 0:\d\d/).waitFor(patience);
  await asks.locator('summary').click();
  await patient.click();
  check('the surgeon asks the anaesthetist for what the scene has, and is told when it is done');

  assert.equal(mock.state.inputs, 0, 'no hand input before a hand is taken');
  await page.keyboard.press('1');
  await page.mouse.move(240, 160);
  await page.mouse.down();
  await page.mouse.move(244, 160);
  await waitFor('hand input', () => mock.state.held[0] !== null);
  const first = [...mock.state.held[0].p_m];
  assert.ok(Math.hypot(...first.map((x, i) => x - mockTool(mock.state)[i])) < 0.003, 'the hand starts at the tool');
  await page.mouse.move(250, 160, { steps: 4 });
  await waitFor('movement', () => Math.hypot(...[...mock.state.held[0].p_m].map((x, i) => x - first[i])) > 1e-4);
  await page.mouse.up();
  await page.keyboard.down('Space');
  await waitFor('button 1', () => mock.state.held[0].button1);
  await page.keyboard.up('Space');
  await waitFor('button 1 up', () => !mock.state.held[0].button1);
  // While the key is held, Tab leads to the other hand and leaves the button on.
  await page.keyboard.down('Space');
  await waitFor('button 1', () => mock.state.held[0].button1);
  await page.keyboard.press('Tab');
  await page.waitForFunction(() => window.__insula.active === 1, null, patience);
  await page.keyboard.up('Space');
  await page.keyboard.down('ArrowLeft');
  await waitFor('the other hand', () => mock.state.held[1] !== null);
  await page.keyboard.up('ArrowLeft');
  await page.keyboard.down('Space');
  await waitFor('both buttons', () => mock.state.held[0].button1 && mock.state.held[1].button1);
  await page.keyboard.up('Space');
  await waitFor('the second button off', () => !mock.state.held[1].button1);
  assert.ok(mock.state.held[0].button1, 'the first one is latched');
  await page.waitForFunction(
    () => document.querySelectorAll('.hand')[0].querySelector('[data-latch="1"]').textContent.includes('held'),
    null,
    patience,
  );
  await page.keyboard.press('1');
  await page.keyboard.press('Space');
  await waitFor('the latch let go', () => !mock.state.held[0].button1);
  check('a button stays latched while one mouse works with the other hand, is shown, and is let go by its key');

  // The left hand is held where it is by one key, and the right one is taken.
  await page.keyboard.press('x');
  await page.waitForFunction(() => window.__insula.active === 1, null, patience);
  await waitFor('the hold', async () => /holds/.test(await page.textContent('.hand:nth-child(1) .hold')));
  const stays = [...mock.state.held[0].p_m];
  await page.keyboard.down('ArrowUp');
  const level = mock.state.held[1].p_m;
  await waitFor('the right hand', () => Math.hypot(...mock.state.held[1].p_m.map((x, i) => x - level[i])) > 1e-4);
  await page.keyboard.up('ArrowUp');
  assert.deepEqual([...mock.state.held[0].p_m], stays);
  await page.keyboard.press('1');
  await waitFor('the end of the hold', async () => /Hold/.test(await page.textContent('.hand:nth-child(1) .hold')));
  assert.deepEqual([...mock.state.held[0].p_m], stays, 'no jump');
  check('a hand is held where it is while the other one works, and taken over again without a jump');

  await page.keyboard.press('2');
  await page.keyboard.press('t');
  await page.waitForSelector('.tray [data-tool=right_clip_applier][aria-pressed=true]', {
    state: 'attached',
    timeout: 60_000,
  });
  await page.keyboard.press('z');
  await page.waitForSelector('.tray [data-tool=right_dissector][aria-pressed=true]', {
    state: 'attached',
    timeout: 60_000,
  });
  check('an exchange of tools is undone by one key');

  const { theatre } = mock.state;
  theatre.run('exchange', 'right right_clip_applier');
  theatre.run('ask', `right_clip_applier load ${theatre.clips[0]}`);
  await page.waitForFunction(() => document.querySelector('.tool-list-head b').textContent.length > 16, null, patience);
  theatre.place(theatre.clips[0]);
  const reach = () => page.textContent('.hand:nth-child(2) .reach');
  await waitFor('the way to the clip', async () => /: \d+\.\d mm away, turned by \d+°/.test(await reach()));
  check(`an empty applier says how far a clip in the field is: ${await reach()}`);
  theatre.run('exchange', 'right right_dissector');
  await page.keyboard.press('1');

  await page.keyboard.press('g');
  await waitFor('the release', () => mock.state.commands.includes('release left'));
  await page.waitForFunction(() => !window.__insula.taken[0] && window.__insula.taken[1], null, patience);
  await click(page, '.controls .timed:nth-child(2)');
  await page.waitForSelector('.dialog.question:not([hidden])', patience);
  assert.ok(!mock.state.commands.includes('reset'), 'it asks first');
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => document.querySelector('.dialog.question').hidden, null, patience);
  assert.ok(!mock.state.commands.includes('reset'));
  await click(page, '.controls .timed:nth-child(2)');
  await click(page, '[data-answer=reset]');
  await waitFor('reset', () => mock.state.commands.includes('reset'));
  await page.waitForFunction(() => !window.__insula.taken[1], null, patience);
  check('mouse and keys drive a hand, without a jump, until it is released; Reset asks, and lets both go');

  await page.keyboard.press('Escape');
  assert.ok(
    await page.evaluate(() => document.activeElement.closest('#hud') !== null),
    'Escape leads from the field to the controls',
  );
  const active = (await status()).active;
  await page.keyboard.press('Tab');
  assert.equal((await status()).active, active, 'and there Tab goes from control to control');
  await page.keyboard.press('h');
  await page.waitForSelector('.dialog.help:not([hidden])', patience);
  const helpFits = await page.evaluate(() => {
    const box = document.querySelector('.dialog.help').getBoundingClientRect();
    return box.top >= 0 && box.bottom <= innerHeight && box.left >= 0 && box.right <= innerWidth;
  });
  assert.ok(helpFits, 'help lies within the window');
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => document.querySelector('.dialog.help').hidden, null, patience);
  check('keyboard users leave the field, and help fits, scrolls and closes');

  away = true;
  const session = (await status()).session;
  await mock.stop();
  await page.waitForFunction(
    () => !window.__insula.connected && document.querySelector('.banner')?.textContent.startsWith('Viewer gateway'),
    null,
    patience,
  );
  mock = await startMock({ port, startS: 3 });
  await page.waitForFunction(
    (old) => window.__insula.connected && window.__insula.ready && window.__insula.session !== old,
    session,
    patience,
  );
  check('it says that the gateway is gone, reconnects, and loads the new session');
  assert.deepEqual(errors, []);
  check('no errors in the console');
} finally {
  await browser.close();
  await mock.stop();
}

/** Where the mock's left tool is when nobody holds it: it hardly moves. */
function mockTool(state) {
  return state.lastTool;
}
