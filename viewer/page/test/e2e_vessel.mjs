// SPDX-License-Identifier: GPL-3.0-or-later
// The aneurysm's side of the page against the mock: tool exchange, choosing a clip, refusals, blood in the picture,
// indocyanine green, stereo, a headset (a made-up one), and the instructor's page beside the trainee's.
import assert from 'node:assert/strict';
import { startMock } from '../scripts/mock-server.mjs';
import { check, launch, look, patience, waitFor } from './browser.mjs';
import { fakeHeadset } from './fake_headset.mjs';

const mock = await startMock({ port: 0, startS: 14 });
const theatre = mock.state.theatre;
const sent = (text) => waitFor(text, () => mock.state.commands.includes(text));
const errors = [];
const browser = await launch();
try {
  const page = await browser.newPage({ viewport: { width: 480, height: 320 } });
  page.setDefaultTimeout(patience.timeout);
  page.on('console', (m) => {
    if (m.type() === 'error') errors.push(m.text());
  });
  page.on('pageerror', (e) => errors.push(e.message));
  await page.addInitScript(fakeHeadset);
  await page.goto(`${mock.url}?quality=low`);
  await page.waitForFunction(() => window.__insula?.ready, null, patience);
  const pictures = async (n) => {
    const from = await page.evaluate(() => window.__insula.pictures);
    await page.waitForFunction((k) => window.__insula.pictures >= k, from + n, patience);
  };
  // Clicks by the page itself: on a slow machine a pointer click waits for pictures.
  const press = (selector) => page.evaluate((s) => document.querySelector(s).click(), selector);
  const textOf = (selector) => page.evaluate((s) => document.querySelector(s)?.textContent ?? '', selector);

  const inHand = (tool) =>
    page.waitForFunction(
      (id) => document.querySelector(`[data-tool=${id}]`)?.getAttribute('aria-pressed') === 'true',
      tool,
      patience,
    );

  assert.equal(await page.locator('[data-tool=right_dissector]').getAttribute('aria-pressed'), 'true');
  assert.ok(await page.locator('[data-tool=right_dissector]').isDisabled());
  await press('[data-tool=right_clip_applier]');
  await sent('exchange right right_clip_applier');
  await inHand('right_clip_applier');
  await page.keyboard.press('t');
  await sent('exchange right right_dissector');
  // The next key counts on from what the page shows in the hand.
  await inHand('right_dissector');
  check('tools are exchanged by button and by key, and the one in hand is marked');

  const clip = theatre.clips[0];
  await page.keyboard.press('l');
  await page.waitForFunction(() => !document.querySelector('.tool-list-entries').hidden, null, patience);
  assert.equal(await page.evaluate(() => document.activeElement.dataset.choice), clip);
  assert.equal(
    await page.evaluate(() =>
      [...document.querySelectorAll('.tool-list-entries img')].every((i) => i.complete && i.naturalWidth > 0),
    ),
    true,
    'every clip has its picture',
  );
  await page.keyboard.press('Enter');
  await page.waitForFunction(
    () => document.querySelector('.toast.refused')?.textContent.includes('take it up first'),
    null,
    patience,
  );
  assert.equal(await textOf(`[data-choice=${clip}] .badge`), '');
  check('a clip asked for while its applier lies on the tray is refused');

  await page.keyboard.press('t');
  await inHand('right_clip_applier');
  mock.state.commands.length = 0;
  await page.keyboard.press('l');
  await page.keyboard.press('Enter');
  await sent(`ask right_clip_applier load ${clip}`);
  await page.waitForFunction(
    (c) =>
      document.querySelector(`[data-choice=${c}] .badge`)?.textContent === 'loaded' &&
      document.querySelector(`[data-choice=${c}]`).disabled,
    clip,
    patience,
  );
  assert.notEqual(await textOf('.tool-list-head b'), 'No clip loaded');
  assert.equal(mock.state.inputs, 0, 'keys in the list move no hand');
  check('a clip is chosen from the drop-down by key; it shows what is loaded');

  theatre.run('exchange', 'right hammer');
  await page.waitForFunction(
    () => document.querySelector('.toast.refused')?.textContent.includes('hammer'),
    null,
    patience,
  );
  check('a refusal is shown');

  theatre.run('message', 'Mind the perforators');
  await page.waitForFunction(
    () => document.querySelector('.toast.instruction')?.textContent.includes('Mind the perforators'),
    null,
    patience,
  );
  check("the instructor's words are shown");

  const field = { x: 205, y: 125, width: 70, height: 70 };
  // The middle of the pool, from two pictures of a frozen field: waves go on, so reflections of the lamp differ; what
  // lies below does not.
  const pool = () => look(page, { x: 190, y: 115, width: 90, height: 90 }, { disc: true });
  const freeze = async () => {
    mock.state.paused = true;
    await pictures(4);
  };
  await freeze();
  const before = await pool();
  mock.state.paused = false;
  theatre.run('ask', 'artery_bleeding rupture');
  await page.waitForFunction(
    () =>
      document.querySelector('[data-timer=rupture]')?.hidden === false &&
      /^4:\d\d$/.test(document.querySelector('[data-timer=rupture] .time').textContent),
    null,
    patience,
  );
  assert.match(await textOf('[data-channel="bleeding.rate"] .value'), /^\d+ mL\/min$/);
  assert.ok(Number(await textOf('[data-channel="flow.parent.pressure"]')) > 20);
  await page.setViewportSize({ width: 1280, height: 720 });
  const room = await page.evaluate(() => {
    const column = document.querySelector('.column.left');
    return { wanted: column.scrollHeight, there: column.clientHeight };
  });
  await page.setViewportSize({ width: 480, height: 320 });
  assert.ok(room.wanted <= room.there, `the monitor is cut off: ${JSON.stringify(room)}`);
  theatre.height = 0.009;
  await pictures(6);
  await freeze();
  const flooded = await pool();
  mock.state.paused = false;
  assert.ok(
    flooded.dark_red > 0.5 && flooded.dark_red > before.dark_red + 0.15,
    `dark red ${before.dark_red} -> ${flooded.dark_red}`,
  );
  assert.ok(
    flooded.spread < 0.4 * before.spread,
    `the field is hidden: contrast ${before.spread} -> ${flooded.spread}`,
  );
  check(
    'timers, flow and blood are told, and blood hides the field ' +
      `(dark red ${(100 * before.dark_red).toFixed(0)} -> ${(100 * flooded.dark_red).toFixed(0)} %, ` +
      `contrast ${before.spread.toFixed(0)} -> ${flooded.spread.toFixed(0)})`,
  );

  theatre.reset();
  await page.keyboard.press('j');
  await sent('ask flow inject_dye');
  await page.keyboard.press('i');
  mock.state.paused = true; // dye is washed out in half a minute, which a slow machine needs for its pictures
  theatre.dyeAt = theatre.time - 4;
  await pictures(12);
  const shining = await look(page, { x: 140, y: 60, width: 200, height: 200 });
  assert.ok(shining.green > 0.01, `greenish ${shining.green}`);
  assert.ok(shining.mean < 70, `dark around: ${shining.mean}`);
  theatre.dyeAt = null;
  await pictures(16);
  const faded = await look(page, { x: 140, y: 60, width: 200, height: 200 });
  assert.ok(faded.green < 0.2 * shining.green, `greenish ${shining.green} -> ${faded.green}`);
  await page.keyboard.press('i');
  mock.state.paused = false;
  check(`the dye is injected and shines (greenish ${(100 * shining.green).toFixed(1)} %), without dye it is dark`);

  await page.keyboard.press('o');
  await page.waitForFunction(() => window.__insula.stereo === 'sbs', null, patience);
  await pictures(8);
  const halves = [];
  for (const x of [85, 325]) halves.push(await look(page, { x, y: 125, width: 70, height: 70 }));
  assert.ok(
    halves.every((h) => h.mean > 15),
    'a picture in each half',
  );
  assert.ok(Math.abs(halves[0].mean - halves[1].mean) < 0.3 * halves[0].mean, 'of the same place');
  await page.keyboard.press('o');
  await pictures(6);
  const cyan = await look(page, field);
  assert.ok(cyan.mean > 10 && cyan.deviation > 5);
  await page.keyboard.press('o');
  check('side by side and red-cyan stereo');

  await page.selectOption('select[aria-label=stereo]', 'xr');
  await page.waitForFunction(() => window.__insula.presenting && window.__headset.pictures > 2, null, patience);
  const eyes = await page.evaluate(() => window.__headset.eyes);
  assert.ok(
    eyes.every((e) => e > 8),
    `brightness in the eyes ${eyes}`,
  );
  const grip = (x) =>
    page.evaluate((x) => {
      const buttons = [0, 1, 2, 3, 4].map((b) => ({ pressed: b < 2 }));
      window.__headset.controllers = [{ handedness: 'left', gripSpace: { x, y: 0, z: 0 }, gamepad: { buttons } }];
    }, x);
  await grip(0);
  await waitFor('the left hand', () => mock.state.held[0]?.button1);
  const from = [...mock.state.held[0].p_m];
  await grip(0.05);
  const way = () => Math.hypot(...[...mock.state.held[0].p_m].map((x, i) => x - from[i]));
  await waitFor('its way', () => Math.abs(way() - 0.01) < 1e-6);
  await page.evaluate(() => {
    window.__headset.controllers = [];
  });
  await waitFor('its button off', () => !mock.state.held[0].button1);
  check('a controller draws its tool along, and lets its button go when it is lost');

  await page.evaluate(() => window.__headset.end());
  await page.waitForFunction(() => !window.__insula.presenting && window.__insula.stereo === 'off', null, patience);
  await pictures(3);
  check('a headset gets a picture in each eye, and the page goes on when it is taken off');

  theatre.reset();
  await page.goto(`${mock.url}?quality=low&role=instructor`);
  await page.waitForFunction(
    () => window.__insula?.ready && document.querySelector('[data-ask="artery_bleeding rupture"]'),
    null,
    patience,
  );
  assert.ok(await page.locator('[data-tool=right_clip_applier]').isDisabled(), 'the instructor exchanges no tools');
  assert.equal(await page.locator('.touch').count(), 0);
  await page.evaluate(() => {
    const slider = document.querySelector('[aria-label^="set systolic"]');
    slider.value = '180';
    slider.dispatchEvent(new Event('input'));
  });
  await press('[data-ask="artery_pressure set_systolic"]');
  await sent('ask artery_pressure set_systolic 180');
  await waitFor('systolic pressure', () => theatre.systolic === 180);
  await page.evaluate(() => {
    document.querySelector('.instructor form input').value = 'Temporary clip first';
    document.querySelector('.instructor form').requestSubmit();
  });
  await sent('message Temporary clip first');
  await press('[data-ask="artery_bleeding rupture"]');
  await sent('ask artery_bleeding rupture');
  await page.waitForFunction(() => document.querySelector('.log [data-kind=rupture]') !== null, null, patience);
  const inputs = mock.state.inputs;
  await page.keyboard.press('w');
  await pictures(2);
  assert.equal(mock.state.inputs, inputs, 'the instructor drives no hand');
  check('the instructor sets the pressure, speaks, makes the aneurysm rupture, sees it in the log, and drives no hand');

  assert.deepEqual(errors, []);
  check('no errors in the console');
} finally {
  await browser.close();
  await mock.stop();
}
