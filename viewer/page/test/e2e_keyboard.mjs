// SPDX-License-Identifier: GPL-3.0-or-later
// The way from the start page through an exercise and back with keys only. At every stop the focus is seen, lies on a
// control of the open dialog if there is one, and comes back to where it was when a dialog closes. Exit status 77: no
// browser, skipped.
import assert from 'node:assert/strict';
import { check, launch, patience, waitFor } from './browser.mjs';
import { answerStart, startPlaces } from './places.mjs';

const browser = await launch();
const mock = await startPlaces('waiting');
const context = await browser.newContext({ viewport: { width: 1000, height: 700 } });
await answerStart(context);
const page = await context.newPage();
const errors = [];
page.on('pageerror', (e) => errors.push(e.message));
await page.addInitScript(() => {
  localStorage.setItem('insula.quality', 'draft');
  window.__pointer = 0;
  for (const kind of ['pointerdown', 'mousedown', 'touchstart']) addEventListener(kind, () => window.__pointer++, true);
});

/** What has the focus: its name, whether it is seen, and how it lies to what is open. */
const focus = () =>
  page.evaluate(() => {
    const e = document.activeElement;
    const style = getComputedStyle(e);
    const box = e.getBoundingClientRect();
    const open = [...document.querySelectorAll('[role=dialog][aria-modal], dialog[open]')]
      .filter((d) => d.checkVisibility())
      .pop();
    return {
      name: `${e.tagName.toLowerCase()}#${e.id}.${e.className} "${(e.textContent || e.title).trim().slice(0, 30)}"`,
      body: e === document.body || e === document.documentElement,
      outline: style.outlineStyle === 'none' ? 0 : parseFloat(style.outlineWidth),
      inWindow: box.bottom > 0 && box.top < innerHeight && box.right > 0 && box.left < innerWidth,
      outsideDialog: open !== undefined && !open.contains(e),
    };
  });

async function seen(where) {
  const f = await focus();
  assert.ok(!f.body, `${where}: the focus is lost`);
  assert.ok(f.outline >= 1, `${where}: the focus is not seen on ${f.name}`);
  assert.ok(f.inWindow, `${where}: ${f.name} has the focus and lies outside of the window`);
  assert.ok(!f.outsideDialog, `${where}: ${f.name} has the focus behind a dialog`);
  return f;
}

const has = (selector) => page.evaluate((s) => document.activeElement.matches(s), selector);
/** Tab until something that matches has the focus. Gives the names of the stops. */
async function tabTo(selector, where, most = 90) {
  const stops = [];
  for (let k = 0; k < most; k++) {
    await page.keyboard.press('Tab');
    // Past the last control a browser gives the focus to its own window.
    if ((await focus()).body) continue;
    stops.push((await seen(where)).name);
    // In the field Tab changes the hand, and Escape leads to the first control.
    if (await has('#view')) {
      await page.keyboard.press('Escape');
      stops.push((await seen(where)).name);
    }
    if (await has(selector)) return stops;
  }
  return assert.fail(`${where}: Tab does not lead to ${selector}: ${stops.join('; ')}`);
}

const until = (test, ...values) => page.waitForFunction(test, values[0] ?? null, patience);
const shown = (selector) => until((s) => document.querySelector(s)?.checkVisibility() ?? false, selector);
const hidden = (selector) => until((s) => !(document.querySelector(s)?.checkVisibility() ?? false), selector);

/** Enter opens a dialog at the control with the focus, Escape closes it, and the control has the focus again. */
async function opensAndCloses(dialog, where) {
  const before = (await focus()).name;
  await page.keyboard.press('Enter');
  await shown(dialog);
  await seen(where);
  for (let k = 0; k < 12; k++) {
    await page.keyboard.press('Tab');
    if (!(await focus()).body) await seen(where);
  }
  await page.keyboard.press('Escape');
  await hidden(dialog);
  assert.equal((await seen(`${where}, closed`)).name, before, `${where}: the focus comes back`);
}

async function startPage() {
  await page.goto(`${mock.url}start.html`);
  await shown('.card');
  const stops = await tabTo('.people button', 'start page');
  assert.equal(stops.length, 4, `language, settings, who, add: ${stops.join('; ')}`);
  await page.keyboard.press('Enter');
  await shown('#pseudonym');
  assert.ok(await has('#pseudonym'), 'the form has the focus');
  await page.keyboard.press('Escape');
  await hidden('#pseudonym');
  assert.ok(await has('.people button'), 'Escape leaves the form');
  await page.keyboard.press('Enter');
  await page.keyboard.type('P21');
  await page.keyboard.press('Enter');
  await until(() => document.querySelector('#person').value === 'P21');
  await seen('a person was added');
  check('a person is added by keys');
  await tabTo('.top button', 'start page');
  await opensAndCloses('dialog.settings', 'settings');
  check('the settings open and close by keys');
}

async function language() {
  await tabTo('select.language', 'start page');
  await page.keyboard.press('ArrowDown');
  await until(() => document.documentElement.lang === 'de' && document.querySelector('.card'));
  await tabTo('select.language', 'German start page');
  await page.keyboard.press('ArrowUp');
  await until(() => document.documentElement.lang === 'en' && document.querySelector('.card'));
  check('the language is chosen by keys, and chosen back');
}

async function exercise() {
  await tabTo('[data-scene$="3_clipping.xml"] button:not(.plain)', 'start page');
  await page.keyboard.press('Enter');
  await page.waitForURL(/index\.html/, patience);
  await shown('.dialog.start');
  await tabTo('[data-answer=practice]', 'choice of a mode', 10);
  await page.keyboard.press('Enter');
  await hidden('.dialog.start');
  assert.ok(await has('#view'), 'the field has the focus');
  await seen('the field');
  check('an exercise is chosen and begun by keys');
}

async function hands() {
  for (let turn = 0; turn < 2; turn++) {
    const active = await page.evaluate(() => window.__insula.active);
    await page.keyboard.down('ArrowLeft');
    await until((h) => window.__insula.taken[h], active);
    await waitFor('the hand in the engine', () => mock.state.held[active] !== null);
    await page.keyboard.up('ArrowLeft');
    await page.keyboard.press('Tab');
    await until((h) => window.__insula.active !== h, active);
  }
  check('both hands move by arrow keys, and Tab changes the hand');
  await page.keyboard.press('2');
  await until(() => window.__insula.active === 1);
  await page.keyboard.press('t');
  await waitFor('the exchange', () => mock.state.commands.some((c) => c.startsWith('exchange right')));
  check('T exchanges the tool');
}

async function controls() {
  await page.keyboard.press('Escape');
  assert.ok(!(await has('#view')), 'Escape leaves the field');
  await seen('first control');
  await tabTo('.tool-list-head', 'session');
  const head = (await focus()).name;
  await page.keyboard.press('Enter');
  await shown('.tool-list-entries');
  await seen('list of clips');
  await page.keyboard.press('Escape');
  await hidden('.tool-list-entries');
  assert.equal((await seen('list of clips, closed')).name, head);
  await tabTo('.controls [aria-haspopup=dialog]', 'session');
  await opensAndCloses('.dialog.question', 'reset');
  await tabTo('.controls [aria-haspopup=dialog][title=H]', 'session');
  await opensAndCloses('.dialog.help', 'help');
  check('the list of clips, the question and the help open, close and give the focus back');
  const stops = await tabTo('.controls [aria-haspopup=dialog][title=H]', 'round of the session', 200);
  assert.ok(stops.length > 15, `${stops.length} stops`);
  check(`Tab goes round ${stops.length} controls of the session, each with a seen focus`);
}

async function end() {
  mock.state.outcome = 'done';
  await shown('.dialog.summary');
  await seen('summary');
  await tabTo('.dialog.summary a[href="start.html"]', 'summary', 30);
  await page.keyboard.press('Enter');
  await page.waitForURL(/start\.html/, patience);
  await shown('.card');
  await tabTo('#person', 'start page again');
  check('the summary leads back to the start page by keys');
}

try {
  await startPage();
  await language();
  await exercise();
  await hands();
  await controls();
  await end();
  assert.equal(await page.evaluate(() => window.__pointer), 0, 'no pointer was used');
  assert.deepEqual(errors, []);
} finally {
  await browser.close();
  await mock.stop();
}
