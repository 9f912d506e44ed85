// SPDX-License-Identifier: GPL-3.0-or-later
// A session is recorded by the real engine and looked at in headless Chromium by real keys and clicks: opened, played,
// moved, annotated, filmed, and set beside itself. Exit status 77: no browser or no programs, skipped.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { check, launch, patience } from './browser.mjs';

const root = fileURLToPath(new URL('../../..', import.meta.url));
const option = (name, otherwise) => {
  const i = process.argv.indexOf(`--${name}`);
  return i < 0 ? otherwise : process.argv[i + 1];
};
const programs = option('programs', join(root, 'build/release/bin'));
const given = option('session', '');
const folder = mkdtempSync(join(tmpdir(), 'insula_replay_'));
if (!existsSync(join(programs, 'gateway'))) {
  console.log(`skipped: no programs in ${programs}`);
  process.exit(77);
}

/** A careless clipping: it has faults. */
function record() {
  const file = join(folder, 'careless.insula');
  const scene = join(root, 'scenes/training/3_clipping.xml');
  execFileSync(join(programs, 'insula'), ['run', scene, '--motion', 'careless', '--record', file, '--quiet']);
  return file;
}

/** The gateway with the page that was built here. */
async function serve(file, bus = 'memq://') {
  const page = ['--page', fileURLToPath(new URL('../dist', import.meta.url))];
  const env = { ...process.env, LCM_DEFAULT_URL: bus };
  const gateway = spawn(join(programs, 'gateway'), [...page, '--port', '0', '--session', file], { env });
  const address = await new Promise((resolve, reject) => {
    let said = '';
    gateway.stdout.on('data', (d) => {
      said += d;
      const found = /recorded sessions at (\S+)/.exec(said);
      if (found) resolve(found[1]);
    });
    gateway.once('exit', () => reject(new Error(`the gateway ended: ${said}`)));
  });
  return { gateway, address };
}

/** The recorded tools over a live exercise, whose hands are at rest. */
async function ghostOverLive(context) {
  const bus = `udpm://239.255.76.67:${20000 + (process.pid % 20000)}?ttl=0`;
  const env = { ...process.env, LCM_DEFAULT_URL: bus };
  const scene = join(root, 'scenes/training/3_clipping.xml');
  const quiet = ['--no-browser', '--no-report', '--no-record', '--no-reload', '--port', '0'];
  const play = ['play', scene, '--motion', 'none', ...quiet];
  const live = spawn(join(programs, 'insula'), play, { env, stdio: 'ignore' });
  const { gateway: other, address: there } = await serve(file, bus);
  try {
    const page = await context.newPage();
    const name = new URL(there).searchParams.get('session');
    await page.goto(new URL(`./?quality=draft&ghost=${name}`, there).href);
    const seen = () => page.waitForFunction(() => window.__insula?.ready, null, patience).then(() => true);
    if (!(await seen().catch(() => false))) {
      assert.equal(await page.evaluate(() => window.__insula.session), '', 'the exercise is heard and not drawn');
      console.log('skipped: no exercise is heard; this machine has no multicast');
      return;
    }
    // The ghost moves with the time of the exercise, so it is seen from the beginning of a pass.
    await page.locator('button', { hasText: /^Reset$/ }).dispatchEvent('click', {}, patience);
    await page.locator('[data-answer=reset]').dispatchEvent('click', {}, patience);
    await page.waitForFunction(() => window.__insula.ghost_tools > 0, null, patience);
    check('the tools of a run are a ghost over the live exercise');
  } finally {
    other.kill('SIGINT');
    const ended = new Promise((resolve) => live.once('exit', resolve));
    live.kill('SIGINT');
    await ended;
  }
}

const status = (page) => page.evaluate(() => ({ ...window.__replay }));
const ready = (page) => page.waitForFunction(() => window.__replay?.ready, null, patience);
/** Until a replay that stands draws no further pictures. */
async function rest(page) {
  let last = -1;
  for (;;) {
    const { pictures } = await status(page);
    if (pictures === last) return;
    last = pictures;
    await page.waitForTimeout(1000);
  }
}
/** Presses a key that jumps, and waits until its picture is on the screen. */
async function press(page, key) {
  const { seeks } = await status(page);
  await page.keyboard.press(key);
  await page.waitForFunction((n) => window.__replay.seeks > n, seeks, patience);
  return status(page);
}
/** Of the times of jumps, in words. */
function spread(timesMs) {
  const sorted = [...timesMs].sort((a, b) => a - b);
  const at = (share) => sorted[Math.floor(share * (sorted.length - 1))].toFixed(0);
  return `${at(0.5)} ms in the median, ${at(0.9)} ms in 9 of 10, ${at(1)} ms at most`;
}
/** Sum of a small copy of the field. A canvas can be read in frames that are drawn; a resize has one drawn. */
async function centre(page) {
  return page.evaluate(async () => {
    const canvas = document.querySelector('.side canvas');
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [64, 48];
    const c = copy.getContext('2d');
    for (;;) {
      window.dispatchEvent(new Event('resize'));
      await new Promise((resolve) => requestAnimationFrame(resolve));
      c.drawImage(canvas, 0, 0, 64, 48);
      const sum = [...c.getImageData(0, 0, 64, 48).data].reduce((x, y) => x + y, 0);
      if (sum > 0) return sum;
    }
  });
}

const file = given || record();
const { gateway, address } = await serve(file);
const browser = await launch();
try {
  const context = await browser.newContext({ viewport: { width: 960, height: 620 }, acceptDownloads: true });
  const page = await context.newPage();
  const errors = [];
  page.on('pageerror', (e) => errors.push(String(e)));
  await page.goto(`${address}&quality=draft`);
  await ready(page);
  let s = await status(page);
  assert.ok(s.duration_s > 5, `${s.duration_s} s were recorded`);
  assert.ok(s.chunks_unpacked_to_open <= s.timeline_chunks + 2, JSON.stringify(s));
  await page.waitForFunction(() => window.__replay.complete_ms > 0, null, patience);
  const { complete_ms: complete } = await status(page);
  const drawn = `is drawn after ${s.open_ms.toFixed(0)} ms, complete after ${complete.toFixed(0)} ms`;
  check(`a session of ${s.duration_s.toFixed(0)} s ${drawn}`);

  s = await press(page, 'End');
  assert.equal(s.time_s, s.duration_s);
  s = await press(page, 'Home');
  assert.equal(s.time_s, 0);
  s = await press(page, 'ArrowRight');
  assert.ok(Math.abs(s.time_s - 1) < 1e-6);
  s = await press(page, 'Shift+ArrowRight');
  assert.ok(Math.abs(s.time_s - 1.1) < 1e-6);
  assert.ok(s.seek_chunks_max <= 2, `${s.seek_chunks_max} chunks were unpacked for one moment`);
  const box = await page.locator('.timeline').boundingBox();
  await page.mouse.move(box.x + 0.25 * box.width, box.y + 50);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 50, { steps: 5 });
  await page.mouse.up();
  await page.waitForFunction((t) => Math.abs(window.__replay.time_s - t) < 0.5, s.duration_s / 2, patience);
  s = await status(page);
  check(`keys and the mouse move in time; a moment is decoded in ${s.decode_max_ms.toFixed(0)} ms at most`);

  const keys = ['End', 'Home', 'f', 'ArrowRight', 'b', 'End', 'Shift+ArrowLeft', 'Home', 'f'];
  const fromRest = [];
  for (const key of keys) {
    await rest(page);
    const { pictures } = await status(page);
    await press(page, key);
    await rest(page);
    s = await status(page);
    assert.equal(s.pictures, pictures + 2, 'a jump takes a picture that comes soon and one in full detail');
    fromRest.push(s.seek_ms);
  }
  check(`a replay that stands draws nothing; a jump from there is in the picture after ${spread(fromRest)}`);
  const inARow = [];
  for (const key of [...keys, ...keys]) {
    const { seek_ms: ms } = await press(page, key);
    inARow.push(ms);
    await page.waitForTimeout(100 * (inARow.length % 5));
  }
  check(`jumps that follow each other are in the picture after ${spread(inARow)}`);

  await press(page, 'Home');
  const times = [];
  for (let k = 0; k < 3; k++) times.push((await press(page, 'f')).time_s);
  assert.ok(times[0] > 0, 'there is a fault');
  assert.ok(times[0] < times[1] && times[1] < times[2], `the faults are at ${times}`);
  assert.equal((await press(page, 'b')).time_s, times[1]);
  await page.waitForFunction(() => document.querySelector('.moments .now [data-kind]'), null, patience);
  const fault = await page.textContent('.moments .now');
  assert.match(await page.textContent('.faults'), /✗/, 'the panel of the exercise says the same');
  check(`it goes from fault to fault: "${fault.trim()}"`);

  await press(page, 'Home');
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('Space');
  await page.waitForFunction(() => window.__replay.time_s > 2, null, patience);
  await page.keyboard.press('Space');
  await page.keyboard.press('v');
  await rest(page);
  const before = (await status(page)).time_s;
  await page.waitForTimeout(300);
  assert.equal((await status(page)).time_s, before, 'it stands');
  check('it plays at four times its speed, and stands on request');

  const early = await centre(page);
  await press(page, 'End');
  assert.notEqual(await centre(page), early, 'the picture has changed');
  const view = await centre(page);
  const field = await page.locator('.side canvas').boundingBox();
  await page.mouse.move(field.x + 300, field.y + 200);
  await page.mouse.down();
  await page.mouse.move(field.x + 420, field.y + 240, { steps: 6 });
  await page.mouse.up();
  await page.waitForTimeout(1500);
  assert.notEqual(await centre(page), view, 'the microscope turns while time stands');
  check('the microscope is free');

  await page.locator('.transport input[type=checkbox]').check(patience);
  await page.selectOption('select[aria-label="second curve"]', { index: 4 }, patience);
  await page.mouse.click(field.x + 300, field.y + 200);
  await press(page, 'Home');
  await press(page, 'ArrowRight');
  await page.keyboard.press('n');
  await page.keyboard.type('the blades are too high here');
  await page.keyboard.press('Enter');
  await page.waitForFunction(
    () => document.querySelector('.moments')?.textContent.includes('too high'),
    null,
    patience,
  );
  const kept = JSON.parse(readFileSync(`${file}.notes.json`, 'utf8'));
  assert.deepEqual(kept, [{ time_s: 1, text: 'the blades are too high here' }]);
  await page.reload();
  await ready(page);
  await page.waitForFunction(
    () => document.querySelector('.moments')?.textContent.includes('too high'),
    null,
    patience,
  );
  await page.locator('.moments .remove').click(patience);
  await page.waitForFunction(
    () => !document.querySelector('.moments').textContent.includes('too high'),
    null,
    patience,
  );
  check('a note is kept beside the file, found again, and removed');

  await press(page, 'Home');
  await page.keyboard.press('[');
  await press(page, 'ArrowRight');
  await page.keyboard.press(']');
  const [film] = await Promise.all([
    page.waitForEvent('download', patience),
    page.locator('.transport button', { hasText: 'Video' }).click(patience),
  ]);
  const path = join(folder, 'film.webm');
  await film.saveAs(path);
  const webm = readFileSync(path);
  assert.equal(webm.subarray(0, 4).toString('hex'), '1a45dfa3', 'EBML');
  assert.ok(webm.length > 2000, `${webm.length} bytes`);
  check(`a stretch becomes a video (${(webm.length / 1000).toFixed(0)} kB)`);

  await page.locator('.transport button', { hasText: 'Debrief' }).click(patience);
  await page.waitForSelector('.debrief .strip figure', patience);
  const sheet = await page.textContent('.debrief');
  const parts = ['Key moments', 'Largest force', 'The end', 'not reached', 'Distance of the tips', 'Metrics'];
  for (const part of [...parts, 'Three things to work on', 'group scripted hands', 'Look at 0:'])
    assert.ok(sheet.includes(part), `${part} in ${sheet}`);
  const shades = await page.evaluate(() =>
    [...document.querySelectorAll('.debrief .strip canvas')].map((c) => {
      const data = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
      return new Set(data).size;
    }),
  );
  assert.ok(
    shades.every((n) => n > 20),
    `every picture shows the field: ${shades}`,
  );
  if (option('keep', '')) await page.pdf({ path: option('keep', ''), preferCSSPageSize: true });
  await page.locator('.debrief [data-answer=close]').click(patience);
  check(`a debrief to print has ${shades.length} pictures of key moments`);

  const name = new URL(page.url()).searchParams.get('session');
  await page.goto(`${page.url()}&with=${name}&ghost=${name}&t=3`);
  await ready(page);
  assert.equal(await page.locator('.side canvas').count(), 2);
  await page.locator('.shift button', { hasText: '+' }).click(patience);
  assert.match(await page.textContent('.shift'), /0\.5 s/);
  s = await press(page, 'ArrowRight');
  assert.ok(Math.abs(s.time_s - 4) < 1e-6);
  check('two sessions stand side by side in step, with a ghost');

  await page.goto(address.replace(/session=.*/, 'session=nothing'));
  await page.waitForSelector('.opening .bad', patience);
  assert.match(await page.textContent('.opening'), /no such session/);
  await page.setInputFiles('.opening input[type=file]', file);
  await ready(page);
  check('a file is opened from the page');
  assert.deepEqual(errors, []);
  await ghostOverLive(context);
} finally {
  await browser.close();
  gateway.kill('SIGINT');
  rmSync(folder, { recursive: true, force: true });
}
