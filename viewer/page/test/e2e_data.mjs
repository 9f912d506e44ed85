// SPDX-License-Identifier: GPL-3.0-or-later
// Data of a plugin that the page has never heard of: its polyline is in the picture, its channel is a curve and in
// the list of the instructor's page; one drawable of each kind is drawn; malformed numbers are said, and nothing else
// breaks. Then another scene, of which nothing of the former one is left.
import assert from 'node:assert/strict';
import { startMock } from '../scripts/mock-server.mjs';
import { check, launch, look, patience } from './browser.mjs';

/** What the panels say of tools: names in the hands, trays, commands, curves and metrics. */
const offered = (page) =>
  page.evaluate(() => {
    const texts = (selector) => [...document.querySelectorAll(selector)].map((e) => e.textContent);
    return {
      hands: texts('.hand .tag'),
      forces: texts('.hand .force'),
      trays: [...document.querySelectorAll('.tray button')].map((b) => b.dataset.tool),
      curves: [...document.querySelectorAll('[data-curve]')].map((e) => e.dataset.curve),
      metrics: document.querySelectorAll('tr[data-metric]').length,
    };
  });

/** The engine goes on with a scene of which nothing moves yet and whose left hand is empty. */
async function anotherScene(page) {
  await page.evaluate(() => (document.querySelector('.metrics').open = true));
  await page.waitForFunction(() => document.querySelector('tr[data-metric]'), null, patience);
  const before = await offered(page);
  assert.ok(before.trays.length > 1 && before.curves.length > 0 && before.hands.every((h) => h !== ''));
  await page.route('**/scene.json', async (route) => {
    const json = await (await route.fetch()).json();
    const hands = json.hands.filter((h) => h.hand !== 'left').map((h) => ({ ...h, tools: h.tools.slice(0, 1) }));
    await route.fulfill({ json: { ...json, hands, channels: [] } });
  });
  mock.state.silent = true;
  mock.state.session += 1000n;
  const session = mock.state.session.toString();
  await page.waitForFunction((s) => window.__insula.session === s, session, patience);
  const after = await offered(page);
  assert.deepEqual(after, { hands: ['', ''], forces: ['–', '–'], trays: [], curves: [], metrics: 0 });
  mock.state.silent = false;
  await page.waitForFunction(() => document.querySelectorAll('.hand .tag')[1].textContent !== '', null, patience);
  check('another scene leaves nothing of the tools, curves and metrics of the former one');
}

const mock = await startMock({ port: 0, startS: 3, samples: true });
const browser = await launch();
const errors = [];
try {
  const page = await browser.newPage({ viewport: { width: 480, height: 320 } });
  page.setDefaultTimeout(patience.timeout);
  page.on('console', (m) => {
    if (m.type() === 'error') errors.push(m.text());
  });
  page.on('pageerror', (e) => errors.push(e.message));
  const pictures = async (n) => {
    const from = await page.evaluate(() => window.__insula.pictures);
    await page.waitForFunction((k) => window.__insula.pictures >= k, from + n, patience);
  };
  const field = { x: 150, y: 40, width: 180, height: 240 };

  await page.goto(`${mock.url}?quality=low&role=instructor`);
  await page.waitForFunction(() => window.__insula?.ready, null, patience);
  await pictures(4);
  const seen = await look(page, field);
  assert.ok(seen.green > 0.01, `greenish ${seen.green}`);
  assert.deepEqual(await page.evaluate(() => window.__insula.problems), []);
  check(
    `an unknown plugin's line is drawn (greenish ${(100 * seen.green).toFixed(1)} %), and one drawable of each kind`,
  );

  const inked = () =>
    page.evaluate(() => {
      const c = document.querySelector('[data-channels="suture.tension"] canvas');
      return c
        ? c
            .getContext('2d')
            .getImageData(60, 0, c.width - 60, c.height - 30)
            .data.some((x) => x > 100)
        : false;
    });
  await page.waitForFunction(() => document.querySelector('[data-channels="suture.tension"] canvas') !== null);
  assert.ok(await inked(), 'the curve is drawn');
  assert.equal(await page.locator('[data-curve="suture.pull"]').count(), 1);
  await page.evaluate(() => document.querySelector('[data-curve="suture.pull"]').click());
  await page.waitForFunction(() => document.querySelector('[data-channels="suture.pull"] canvas') !== null);
  check("its channel is a curve on the instructor's page; others become one by a tick");

  mock.state.malformed = true;
  await page.waitForFunction(() => window.__insula.problems.length > 5, null, patience);
  const said = await page.evaluate(() => document.querySelector('.notices').textContent);
  assert.match(said, /suture\.thread: 97 numbers are not a multiple of 96/);
  await pictures(4);
  const without = await look(page, field);
  assert.ok(without.green < 0.2 * seen.green, `greenish ${seen.green} -> ${without.green}`);
  assert.ok(without.mean > 15, 'the rest of the picture goes on');
  mock.state.malformed = false;
  await page.waitForFunction(() => window.__insula.problems.length === 0, null, patience);
  await pictures(4);
  const again = await look(page, field);
  assert.ok(again.green > 0.5 * seen.green, `greenish ${again.green}`);
  check('malformed numbers are said and hide their drawable alone; sound ones bring it back');

  await anotherScene(page);
  assert.deepEqual(errors, []);
  check('no errors in the console');
} finally {
  await browser.close();
  await mock.stop();
}
