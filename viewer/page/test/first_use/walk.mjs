// SPDX-License-Identifier: GPL-3.0-or-later
// The way from first use to certificate with no terminal, for each browser: somebody adds himself, takes a small
// curriculum, works its two tasks by keys, and gets the certificate.
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { check, patience } from '../browser.mjs';
import { ownBus, Programs } from '../programs.mjs';

export async function shot(page, name) {
  const path = join(process.env.INSULA_SHOTS ?? '', `${name}.png`);
  if (process.env.INSULA_SHOTS) await page.screenshot({ path, timeout: patience.timeout });
}

/** Nobody has used the programs of this place before. */
export class FirstUse {
  folder = mkdtempSync(join(tmpdir(), 'insula_first_use_'));
  curriculum = join(this.folder, 'curricula/first_use.xml');
  programs = new Programs();
  /** What is done at each stop of the way. */
  visited = shot;

  constructor() {
    mkdirSync(join(this.folder, 'curricula'));
    // A curriculum of the user's data names files as if it lay beside the shipped ones.
    const xml = readFileSync(new URL('first_use.xml', import.meta.url), 'utf8');
    writeFileSync(this.curriculum, xml.replaceAll('one_ball.xml', '../viewer/page/test/first_use/one_ball.xml'));
  }

  /** words: further ones of `insula play`. */
  async open(...words) {
    const { address, said } = await this.programs.play(this.folder, words, ownBus(9000));
    return Object.assign(this, { address, said });
  }

  async end() {
    await this.programs.end();
    rmSync(this.folder, { recursive: true, force: true });
  }
}

const course = (page) => page.evaluate(async () => (await fetch('api/curriculum?person=P07')).json());

/** The right hand becomes the active one. */
async function takeRightHand(page) {
  await page.waitForFunction(() => window.__insula?.ready && window.__insula.frames > 5, null, patience);
  const active = () => page.evaluate(() => document.querySelectorAll('.hand')[1].classList.contains('active'));
  while (!(await active())) await page.keyboard.press('Tab');
}

/** The right hand goes to the left until the exercise is over. */
async function touchTheBall(page) {
  await takeRightHand(page);
  const over = () => page.evaluate(() => document.querySelector('.dialog.summary')?.checkVisibility() ?? false);
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

async function follow(page, { address, visited }) {
  await page.goto(address);
  await page.waitForSelector('.card', patience);
  assert.equal(await page.locator('.course').isVisible(), false, 'a guest has no curriculum');
  await page.getByRole('button', { name: 'Add a person' }).click();
  await page.keyboard.type('P07');
  await page.keyboard.press('Enter');
  await page.locator('#curriculum').selectOption('first_use', patience);
  await visited(page, 'choose');
  await page.getByRole('button', { name: 'Follow it' }).click();
  await page.locator('.next .continue').waitFor(patience);
  assert.equal((await course(page)).next.task, 'practise');
  assert.equal(await page.locator('[data-module=last]').getAttribute('data-standing'), 'locked');
  await visited(page, 'course');
  check('somebody adds himself and follows a curriculum');
}

/** inExercise: what else is looked at in the first exercise. */
async function practise(page, { address, visited }, inExercise) {
  await page.locator('.next .continue').click();
  await page.waitForURL(/index\.html/, patience);
  await takeRightHand(page);
  await visited(page, 'exercise');
  await inExercise(page);
  await touchTheBall(page);
  await visited(page, 'summary');
  await page.goto(address);
  await page.locator('[data-module=first][data-standing=passed]').waitFor(patience);
  const { next } = await course(page);
  assert.deepEqual([next.task, next.start], ['test', 'test']);
  check('the first module is passed by hand, and the last one opens');
}

/** Returns the run that counts. */
async function beTested(page, { address, visited }) {
  await page.locator('.next .continue').click();
  await page.waitForURL(/index\.html/, patience);
  await touchTheBall(page);
  await page.goto(address);
  await page.getByText('You have passed this curriculum.').waitFor(patience);
  await visited(page, 'passed');
  const run = (await course(page)).modules[1].tasks[0].runs.at(-1);
  assert.deepEqual([run.mode, run.state], ['test', 'done']);
  check('the last module is passed by hand, as a test');
  return run;
}

async function certificate(page, { programs, folder, curriculum, visited }, run) {
  await page.locator('.next .certificate').click();
  await page.locator('.sheet').waitFor(patience);
  await visited(page, 'certificate');
  const sheet = await page.locator('.sheet').innerText();
  for (const words of ['P07', 'First use', 'no licence to operate', run.uuid]) assert.ok(sheet.includes(words));
  const told = programs.insula(['people', 'certificate', 'P07', curriculum, '--data', folder]);
  const digest = /digest (\S+)/.exec(told)[1];
  assert.ok(sheet.includes(digest), `the command line says ${digest}`);
  check('the certificate names the runs, and the command line computes the same digest');
}

export async function walkToCertificate(page, place, inExercise = async () => {}) {
  await follow(page, place);
  await practise(page, place, inExercise);
  const run = await beTested(page, place);
  await certificate(page, place, run);
}
