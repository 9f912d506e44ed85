// SPDX-License-Identifier: GPL-3.0-or-later
// The layout of the pages at four sizes of the window: nothing lies outside of it or beneath something else, no text is
// cut or too small, and no panel covers another. In English, in Chinese, and in a language made by machine whose texts
// are one third longer; that one also finds texts that are in no catalogue. INSULA_SHOTS names a folder for pictures.
// Exit status 77: no browser, skipped.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { exercise } from '../scripts/mock/scene.mjs';
import { check, launch, patience } from './browser.mjs';
import { layoutFaults, panelsOverlap, textsOutside } from './layout_faults.mjs';
import { answerStart, openSession, openStart, startPlaces } from './places.mjs';
import { speakPseudo } from './pseudo_language.mjs';

const sizes = [
  [1366, 768],
  [1920, 1080],
  [820, 1180],
  [3840, 2160],
];
/**
 * What no catalogue has: names, units, a month, a word of lists, and what the mock's engine and the stations of a
 * room say.
 */
const names = [
  ...['Insula', 'http://192.0.2.3:8080/', 'Table', 'Februar', 'mmHg', 'mL/min', 'min', 'mm'],
  ...['Clipping', 'A strand was torn', 'Hold more gently'],
  'und', // of lists, which the platform writes
  ...[exercise.text, exercise.title, ...exercise.goals.map((g) => g.text), ...exercise.faults.map((f) => f.text)],
];
const browser = await launch();
const mock = await startPlaces('practice');
const shots = process.env.INSULA_SHOTS;
const wrong = [];
const began = performance.now();

async function lookAt(page, language, view) {
  const found = [];
  for (const [width, height] of sizes) {
    await page.setViewportSize({ width, height });
    await page.evaluate(() => new Promise(window.__frames ?? requestAnimationFrame));
    const where = `${view}, ${language}, ${width} x ${height}`;
    const path = shots && join(shots, `${view.replaceAll(' ', '_')}_${language}_${width}.png`);
    if (path) await page.screenshot({ path, timeout: patience.timeout });
    const faults = [...(await page.evaluate(layoutFaults)), ...(await page.evaluate(panelsOverlap))];
    for (const f of faults) found.push(`${where}: ${f}`);
  }
  if (language === 'long')
    for (const t of await page.evaluate(textsOutside, names)) found.push(`${view}: "${t}" is in no catalogue`);
  for (const f of found) console.log(`bad ${f}`);
  if (found.length === 0) check(`${view}, ${language}: fits at ${sizes.length} sizes`);
  wrong.push(...found);
  const seconds = (performance.now() - began) / 1000;
  console.log(`    after ${seconds.toFixed(0)} s`);
}

async function startViews(page, language) {
  await openStart(page, mock.url);
  await lookAt(page, language, 'start page');
  await page.locator('.top button').first().click();
  await page.waitForSelector('dialog.settings[open]', patience);
  await lookAt(page, language, 'settings');
}

async function sheets(page, language) {
  for (const view of ['login', 'room']) {
    await page.goto(`${mock.url}${view}.html`);
    await page.waitForSelector('button', patience);
    await lookAt(page, language, view);
  }
  await page.goto(`${mock.url}certificate.html?person=P07&curriculum=residency_year`);
  await page.waitForSelector('.sheet', patience);
  await lookAt(page, language, 'certificate');
}

/** Drawing in software leaves a page of 4K no time. The panels are laid out without it. */
const drawing = (page, on) =>
  page.evaluate((draw) => {
    if (draw) {
      window.requestAnimationFrame = window.__frames;
      window.__late.forEach((f) => requestAnimationFrame(f));
      return;
    }
    Object.assign(window, { __frames: window.requestAnimationFrame, __late: [] });
    window.requestAnimationFrame = (f) => window.__late.push(f);
  }, on);

async function session(page, language) {
  mock.state.outcome = '';
  await page.setViewportSize({ width: 820, height: 600 });
  await openSession(page, mock.url);
  await drawing(page, false);
  await lookAt(page, language, 'session');
  await page.setViewportSize({ width: 820, height: 600 });
  await drawing(page, true);
  mock.state.outcome = 'done';
  await page.waitForFunction(() => document.querySelector('.dialog.summary')?.checkVisibility(), null, patience);
  await drawing(page, false);
  await lookAt(page, language, 'summary');
  await page.keyboard.press('Escape');
  await lookAt(page, language, 'field after the end');
}

async function speak(language) {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
  await answerStart(context);
  if (language === 'long') await speakPseudo(context);
  const tag = language === 'long' ? 'de' : language;
  await context.addInitScript((t) => localStorage.setItem('insula.language', t), tag);
  const page = await context.newPage();
  page.on('pageerror', (e) => wrong.push(`${language}: ${e.message}`));
  await startViews(page, language);
  await sheets(page, language);
  await session(page, language);
  await context.close();
}

try {
  const only = process.argv[2];
  for (const language of ['en', 'long', 'zh']) if (!only || only === language) await speak(language);
  assert.equal(wrong.join('\n'), '');
} finally {
  await browser.close();
  await mock.stop();
}
