// SPDX-License-Identifier: GPL-3.0-or-later
// From first use to certificate with no terminal: the real programs in headless Chromium. Somebody adds himself, takes
// a small curriculum, works its two tasks by keys, and gets the certificate. Exit
// status 77: no browser, no programs or no multicast, skipped.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { check, launch, patience } from './browser.mjs';

const root = fileURLToPath(new URL('../../..', import.meta.url));
const programs = join(root, 'build/release/bin');
if (!existsSync(join(programs, 'gateway'))) {
  console.log(`skipped: no programs in ${programs}`);
  process.exit(77);
}
const folder = mkdtempSync(join(tmpdir(), 'insula_certificate_'));
mkdirSync(join(folder, 'curricula'));
const curriculum = join(folder, 'curricula/first_use.xml');
// A curriculum of the user's data names files as if it lay beside the shipped ones.
const xml = readFileSync(new URL('first_use/first_use.xml', import.meta.url), 'utf8');
writeFileSync(curriculum, xml.replaceAll('one_ball.xml', '../viewer/page/test/first_use/one_ball.xml'));

const bus = `udpm://239.255.76.67:${20000 + ((process.pid + 9000) % 20000)}?ttl=0`;
const words = ['play', '--no-browser', '--no-reload', '--port', '0', '--data', folder];
const play = spawn(join(programs, 'insula'), words, { cwd: root, env: { ...process.env, LCM_DEFAULT_URL: bus } });
const address = await new Promise((resolve) => {
  let said = '';
  play.stdout.on('data', (d) => {
    said += d;
    const found = /viewer at (\S+)/.exec(said);
    if (found) resolve(found[1]);
  });
  play.once('exit', (status) => {
    console.log(`skipped: insula play ended with ${status}: ${said}`);
    process.exit(77);
  });
});

const browser = await launch();
const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
const page = await context.newPage();
const errors = [];
page.on('pageerror', (e) => errors.push(e.message));
const shots = process.env.INSULA_SHOTS;
const shot = (name) =>
  shots ? page.screenshot({ path: join(shots, `${name}.png`), timeout: patience.timeout }) : null;
const course = () => page.evaluate(async () => (await fetch('api/curriculum?person=P07')).json());

/** The right hand goes to the left until the exercise is over. */
async function touchTheBall() {
  await page.waitForFunction(() => window.__insula?.ready && window.__insula.frames > 5, null, patience);
  const over = () => page.evaluate(() => document.querySelector('.dialog.summary')?.checkVisibility() ?? false);
  const active = () => page.evaluate(() => document.querySelectorAll('.hand')[1].classList.contains('active'));
  while (!(await active())) await page.keyboard.press('Tab');
  const end = Date.now() + patience.timeout;
  for (let k = 0; !(await over()) && Date.now() < end; k++) {
    // A late picture may take the hand past the ball: then it comes back.
    const key = k % 16 < 10 ? 'ArrowLeft' : 'ArrowRight';
    await page.keyboard.down(key);
    await page.waitForTimeout(80);
    await page.keyboard.up(key);
    await page.waitForTimeout(500);
  }
  assert.ok(await over(), 'the exercise has ended');
}

try {
  await page.goto(address);
  await page.waitForSelector('.card', patience);
  assert.equal(await page.locator('.course').isVisible(), false, 'a guest has no curriculum');
  await page.getByRole('button', { name: 'Add a person' }).click();
  await page.keyboard.type('P07');
  await page.keyboard.press('Enter');
  await page.locator('#curriculum').selectOption('first_use', patience);
  await shot('choose');
  await page.getByRole('button', { name: 'Follow it' }).click();
  await page.locator('.next .continue').waitFor(patience);
  assert.equal((await course()).next.task, 'practise');
  assert.equal(await page.locator('[data-module=last]').getAttribute('data-standing'), 'locked');
  await shot('course');
  check('somebody adds himself and follows a curriculum');

  await page.locator('.next .continue').click();
  await page.waitForURL(/index\.html/, patience);
  await touchTheBall();
  await page.goto(address);
  await page.locator('[data-module=first][data-standing=passed]').waitFor(patience);
  const next = (await course()).next;
  assert.deepEqual([next.task, next.start], ['test', 'test']);
  check('the first module is passed by hand, and the last one opens');

  await page.locator('.next .continue').click();
  await page.waitForURL(/index\.html/, patience);
  await touchTheBall();
  await page.goto(address);
  await page.getByText('You have passed this curriculum.').waitFor(patience);
  await shot('passed');
  const runs = (await course()).modules[1].tasks[0].runs;
  assert.deepEqual([runs.at(-1).mode, runs.at(-1).state], ['test', 'done']);
  check('the last module is passed by hand, as a test');

  await page.locator('.next .certificate').click();
  await page.locator('.sheet').waitFor(patience);
  await shot('certificate');
  const sheet = await page.locator('.sheet').innerText();
  for (const words of ['P07', 'First use', 'no licence to operate', runs.at(-1).uuid]) assert.ok(sheet.includes(words));
  const told = spawnSync(join(programs, 'insula'), ['people', 'certificate', 'P07', curriculum, '--data', folder], {
    cwd: root,
    encoding: 'utf8',
  });
  assert.equal(told.status, 0, told.stderr);
  const digest = /digest (\S+)/.exec(told.stdout)[1];
  assert.ok(sheet.includes(digest), `the command line says ${digest}`);
  check('the certificate names the runs, and the command line computes the same digest');
  assert.deepEqual(errors, []);
} finally {
  await browser.close();
  play.removeAllListeners('exit');
  const ended = new Promise((resolve) => play.once('exit', resolve));
  play.kill('SIGINT');
  await ended;
  rmSync(folder, { recursive: true, force: true });
}
