// SPDX-License-Identifier: GPL-3.0-or-later
// Twenty stations on one machine: real gateways and recorded engines, and an overview that asks them all, lists one
// more and opens one. Then whether the instructor's pointer and pencil reach the trainee's page without a wait. Exit
// status 77: no browser, no programs or no multicast, skipped.
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { check, click, launch, patience } from './browser.mjs';
import { Programs } from './programs.mjs';
import { recorder } from './recorded_engine.mjs';

const count = 20;
const programs = new Programs();
const began = performance.now();
const folder = mkdtempSync(join(tmpdir(), 'insula_room_'));
const firstBus = 20000 + ((process.pid * 23) % 20000);
const buses = Array.from({ length: count }, (_, k) => `udpm://239.255.76.67:${firstBus + k}?ttl=0`);

/** Lists one more station in the dialog. The text of the error that is shown; '': it was taken. */
async function addStation(page, name, url) {
  await page.getByLabel('Name', { exact: true }).fill(name);
  await page.getByLabel('Address', { exact: true }).fill(url);
  const answered = page.waitForResponse(/api\/room\/stations$/, patience);
  await page.evaluate(() => (document.querySelector('.why').textContent = ''));
  await click(page, '.station-form button[type=submit]');
  await answered;
  await page.waitForFunction(
    () => !document.querySelector('.station-form').open || document.querySelector('.why').textContent !== '',
    null,
    patience,
  );
  return page.evaluate(() => document.querySelector('.why').textContent);
}

/**
 * From now on, keeps the time of the last pointer event; of pointer and strokes, what is sent and what is shown, with
 * the kind of the event in whose handler that is done ('': in none). Times are ms since 1970.
 */
const watch = (page) =>
  page.evaluate(() => {
    const now = () => performance.timeOrigin + performance.now();
    const during = () => window.event?.type ?? '';
    Object.assign(window, { __acted: 0, __sent: [], __shown: [] });
    for (const kind of ['pointerdown', 'pointerrawupdate'])
      document
        .querySelector('canvas.strokes')
        .addEventListener(kind, (e) => (window.__acted = performance.timeOrigin + e.timeStamp), { capture: true });
    const send = WebSocket.prototype.send;
    WebSocket.prototype.send = function (bytes) {
      const kind = /"kind":"(point|stroke)"/.exec(new TextDecoder().decode(bytes))?.[1];
      if (kind) window.__sent.push({ ms: now(), kind, during: during() });
      return send.call(this, bytes);
    };
    const ring = document.querySelector('i.pointed');
    Object.defineProperty(ring.style, 'translate', {
      set(value) {
        this.setProperty('translate', value);
        const { x, y, width, height } = ring.getBoundingClientRect();
        const place = [x + width / 2, y + height / 2];
        window.__shown.push({ ms: now(), kind: 'point', place, during: during() });
      },
    });
    Object.defineProperty(window.__insula, 'stroke_ms', {
      set() {
        window.__shown.push({ ms: now(), kind: 'stroke', during: during() });
      },
    });
  });

/** What is kept first after an act. near: within 1.5 pixels of a place. */
async function first(page, list, kind, since, near = null) {
  const found = await page.waitForFunction(
    ([of, wanted, after, at]) =>
      window[of].find(
        (m) => m.kind === wanted && m.ms > after && (!at || Math.hypot(m.place[0] - at[0], m.place[1] - at[1]) < 1.5),
      ),
    [list, kind, since, near],
    { ...patience, polling: 10 },
  );
  return found.jsonValue();
}

const acts = 9;
/** What follows another message within a thirtieth of a second waits for the rest of it. */
const most = Math.ceil(acts / 2);

/**
 * Does something with the instructor's pointer several times. Both pages' pictures are drawn by software on one
 * machine, and nobody may wait for them: the instructor's page sends in the handler of the pointer's event, at least
 * `atOnce` times, and the trainee's shows in that of the message.
 */
async function tell(what, kind, atOnce, instructor, trainee, act) {
  const delays = [];
  let sentAtOnce = 0;
  for (let k = 0; k < acts; k++) {
    const near = await act(k);
    const acted = await instructor.evaluate(() => window.__acted);
    const sent = await first(instructor, '__sent', kind, acted);
    const shown = await first(trainee, '__shown', kind, acted, near);
    assert.equal(shown.during, 'message', `${what}: it is shown with the message`);
    sentAtOnce += sent.during.startsWith('pointer') ? 1 : 0;
    delays.push(shown.ms - acted);
  }
  delays.sort((a, b) => a - b);
  const [median, worst] = [delays[Math.floor(acts / 2)], delays.at(-1)].map((ms) => ms.toFixed(0));
  console.log(`${what}: ${sentAtOnce} of ${acts} sent at once; median ${median} ms, worst ${worst} ms`);
  assert.ok(sentAtOnce >= atOnce, `${what}: ${sentAtOnce} of ${acts} were sent at once`);
}

const browser = await launch();
try {
  const record = await recorder({ folder, seconds: 4, rate: 10 });
  const engines = [];
  const urls = await Promise.all(
    buses.map((bus, k) => {
      engines.push(programs.start('insula', ['replay', record(`Exercise ${k + 1}`), '--loop'], bus));
      return programs.gateway(['--station', `table ${k + 1}`, '--no-mdns'], bus);
    }),
  );
  const listed = urls.slice(0, count - 1).map((u, k) => `Table_${k + 1} ${u}`);
  writeFileSync(join(folder, 'stations'), listed.join('\n'));
  mkdirSync(join(folder, 'own'));
  const own = ['--own', join(folder, 'own'), '--no-mdns'];
  const desk = await programs.gateway(['--stations', join(folder, 'stations'), ...own], 'memq://');
  const page = await browser.newPage({ viewport: { width: 1366, height: 1100 } });
  await page.goto(`${desk}room.html`);
  await page.getByText(`${count - 1} of ${count - 1} stations answer`).waitFor(patience);
  await page.getByRole('button', { name: 'Add a station' }).click();
  assert.match(await addStation(page, `Table_${count}`, 'http://table:99999/'), /no address of a station/);
  assert.match(await addStation(page, `Table_${count}`, urls[0]), /this address is listed already/);
  assert.equal(await addStation(page, `Table_${count}`, urls.at(-1)), '');
  await page.reload();
  await page.getByText(`${count} of ${count} stations answer`).waitFor(patience);
  check('a station is listed in a dialog, and a wrong address is told');

  const alarmed = page.locator('.station[data-standing=alarm]');
  await page.waitForFunction((n) => document.querySelectorAll('[data-standing=alarm]').length === n, count, patience);
  for (let k = 0; k < count; k++) {
    const card = await alarmed.nth(k).innerText();
    assert.match(card, new RegExp(`Table_${k + 1}\\b[^]*Exercise ${k + 1}\\b[^]*torn at Exercise ${k + 1}\\b`));
  }
  check(`the overview shows ${count} stations with their exercise and alarms`);

  // A trainee's page with a plain picture; this machine draws it without a graphics card.
  const trainee = await browser.newPage({ viewport: { width: 480, height: 270 } });
  await trainee.goto(`${urls[6]}?quality=draft`);
  await trainee.waitForFunction(() => window.__insula?.ready, null, patience);
  await page.locator('.station').nth(6).locator('img:not([hidden])').waitFor(patience);
  const shown = await page
    .locator('.station')
    .nth(6)
    .locator('img')
    .evaluate((i) => i.decode().then(() => i.naturalWidth));
  assert.equal(shown, 320);
  check('the picture of a trainee who works arrives in the overview');
  if (process.env.INSULA_SHOTS) await page.screenshot({ path: join(process.env.INSULA_SHOTS, 'room.png') });

  const [opened] = await Promise.all([
    page.waitForEvent('popup'),
    page.locator('.station').nth(6).getByRole('button', { name: 'Open' }).click(),
  ]);
  await opened.waitForURL(/role=instructor/, patience);
  assert.ok(opened.url().startsWith(urls[6]), 'the page of that station');
  check('a station opens from the overview');

  await opened.close(); // its picture, drawn by software, would leave the others little time
  await page.bringToFront(); // a page behind another one draws nothing, and Playwright waits for its picture
  page.once('dialog', (d) => d.accept());
  await page.getByRole('button', { name: `Remove Table_${count} from the list` }).click();
  await page.waitForFunction((n) => document.querySelectorAll('.station').length === n, count - 1, patience);
  await page.close();
  // The gateway takes the overview for closed after ten seconds. Then no picture follows for eight seconds, while one
  // every three seconds would if somebody looked.
  const thumbnails = () => trainee.evaluate(() => window.__insula.thumbnails);
  let before = await thumbnails();
  assert.ok(before > 0);
  let quiet = false;
  for (let k = 0; k < 8 && !quiet; k++) {
    await new Promise((r) => setTimeout(r, 8000));
    const now = await thumbnails();
    quiet = now === before;
    before = now;
  }
  assert.ok(quiet, 'pictures go on');
  check('no picture is read back when nobody looks at the overview');

  engines.forEach((engine, k) => k !== 6 && engine.kill('SIGTERM'));
  const instructor = await browser.newPage({ viewport: { width: 960, height: 540 } });
  await instructor.goto(`${urls[6]}?role=instructor&quality=draft`);
  await instructor.waitForFunction(() => window.__insula?.ready, null, patience);
  const button = (label) =>
    instructor.evaluate(
      (l) => [...document.querySelectorAll('.pencil button')].find((b) => b.textContent === l).click(),
      label,
    );
  await button('Point');
  await watch(instructor);
  await watch(trainee);
  // Both look through the same lens, and the trainee's picture is half as large.
  await tell('pointing', 'point', most, instructor, trainee, async (k) => {
    const at = [400 + 10 * k, 250 + 5 * k];
    await instructor.mouse.move(...at);
    return at.map((x) => x / 2);
  });
  await button('Draw');
  // How long the beginning of a stroke waits for its depth is tested without a browser (pencil.test.ts).
  await tell('beginning a stroke', 'stroke', 0, instructor, trainee, async (k) => {
    await instructor.mouse.up();
    await instructor.mouse.move(420 + 10 * k, 250);
    await instructor.mouse.down();
  });
  await tell('drawing', 'stroke', most, instructor, trainee, (k) => instructor.mouse.move(520 + 10 * k, 260));
  await instructor.mouse.up();
  assert.ok((await trainee.evaluate(() => window.__insula.strokes)) > 0);
  check('pointer and strokes go from page to page');
  console.log(`${((performance.now() - began) / 1000).toFixed(0)} s`);
} finally {
  await browser.close();
  await programs.end();
  rmSync(folder, { recursive: true, force: true });
}
