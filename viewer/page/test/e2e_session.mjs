// SPDX-License-Identifier: GPL-3.0-or-later
// A session from its start to its end in headless Chromium: what it shall be is chosen, targets are shown in practice,
// a message stays until it is read, and the end says what was reached. Then the layout on four screens. Exit status
// 77: no browser, skipped.
import assert from 'node:assert/strict';
import { startMock } from '../scripts/mock-server.mjs';
import { check, click, launch, patience, waitFor } from './browser.mjs';

const mock = await startMock({ port: 0, startS: 3, mode: 'waiting' });
const browser = await launch();
const shown = (page, selector) => page.waitForSelector(`${selector}:not([hidden])`, patience);
const hidden = (page, selector) => page.waitForFunction((s) => document.querySelector(s).hidden, selector, patience);
try {
  const page = await browser.newPage({ viewport: { width: 480, height: 400 } });
  await page.goto(`${mock.url}?quality=low`);
  await shown(page, '.dialog.start');
  assert.ok(await page.evaluate(() => window.__insula.ready), 'it asks when a picture is there');
  assert.equal(mock.state.time, 3, 'nothing has begun yet');
  assert.ok(!mock.state.commands.some((c) => c.startsWith('begin')));
  await click(page, '[data-answer=practice]');
  await waitFor('the choice', () => mock.state.commands.includes('begin practice'));
  await hidden(page, '.dialog.start');
  check('a session waits until somebody chooses to watch, to try or to be tested');

  await page.waitForFunction(() => window.__insula.target?.of === 2, null, patience);
  await shown(page, '.guide');
  assert.match(await page.textContent('.guide'), /Target 1 of 2/);
  await page.keyboard.press('n');
  await page.waitForFunction(() => window.__insula.target?.at === 1, null, patience);
  assert.match(await page.textContent('.guide .todo'), /button 1/);
  const angle = () => page.evaluate(() => window.__insula.target.angle_rad);
  const turned = await angle();
  await page.keyboard.press('y');
  await waitFor('the wrist', async () => (await angle()) < 0.5 * turned);
  check(`the wrist is turned to its target on request (${turned.toFixed(2)} rad)`);
  mock.state.mode = 'test';
  await hidden(page, '.guide');
  check('practice shows targets for the hand and what the wrist must do; a test does not');

  const recordingReads = (words) =>
    page.waitForFunction((w) => document.querySelector('.recording').textContent === w, words, patience);
  mock.state.unrecorded = 'the disk is full';
  await recordingReads('Not recorded: the disk is full');
  Object.assign(mock.state, { recording: '/s/a.insula', unrecorded: '' });
  await recordingReads('● Recorded');
  check('the page shows that it records, or why it does not');

  mock.state.theatre.say('message', 'message', 'Look at the branch');
  await page.waitForSelector('.toast.instruction', patience);
  await click(page, '.toast.instruction button');
  await waitFor('the receipt', () => mock.state.commands.includes('read Look at the branch'));
  check('a message stays until it is read, and the instructor hears of it');

  mock.state.theatre.placedAt = 5;
  Object.assign(mock.state, { outcome: 'failed', time: 10.5, mode: 'demonstration' });
  await shown(page, '.dialog.summary');
  Object.assign(mock.state, { report: '/home/a/insula-reports/x/report.html' });
  await page.waitForFunction(
    () => document.querySelector('.dialog.summary').textContent.includes('/home/a/insula-reports/x/report.html'),
    null,
    patience,
  );
  await click(page, '.dialog.summary .metrics summary');
  await page.waitForFunction(
    () => /Path of the hand\d+ mm\d+ mmless/.test(document.querySelector('.summary .metrics table').textContent),
    null,
    patience,
  );
  const text = await page.textContent('.dialog.summary');
  for (const part of ['not yours', 'reached: ', '0:10.0', 'Hold more gently'])
    assert.ok(text.includes(part), `${part} in ${text}`);
  await page.setViewportSize({ width: 900, height: 500 });
  const end = await page.evaluate(endPanel);
  assert.ok(end.scrolls, 'the list is longer than the window');
  assert.ok(end.listBottom <= end.answersTop && end.lastBottom <= end.answersTop, JSON.stringify(end));
  assert.ok(end.answersBottom <= 500, JSON.stringify(end));
  check('the end scrolls above its answers, and nothing lies below them');
  await click(page, '[data-answer=close]');
  await hidden(page, '.dialog.summary');
  Object.assign(mock.state, { outcome: '', report: '' });
  check('the end says what was reached, each fault with its time and what to do, whose result it is, and where it is');

  for (const [width, height, least] of [
    [390, 844, 0.75],
    [820, 1180, 0.8],
    [1366, 768, 0.4],
    [1920, 1080, 0.6],
  ]) {
    await page.setViewportSize({ width, height });
    const { free, lost } = await page.evaluate(layout);
    assert.ok(free >= least, `${width}x${height}: ${Math.round(100 * free)} % of the window show the field`);
    assert.deepEqual(lost, [], `${width}x${height}: out of reach`);
    for (const tab of width <= 900 ? ['left', 'right'] : []) {
      await click(page, `[data-tab=${tab}]`);
      assert.deepEqual((await page.evaluate(layout)).lost, [], `${width}x${height}, ${tab} opened: out of reach`);
      await click(page, `[data-tab=${tab}]`);
    }
  }
  check('the field is seen and every control is reached on a phone, a tablet and two screens');
} finally {
  await browser.close();
  await mock.stop();
}

/** Where the end's list and its answers lie, with the list scrolled to its end. */
function endPanel() {
  const box = (selector) => document.querySelector(`.dialog.summary ${selector}`).getBoundingClientRect();
  const list = document.querySelector('.dialog.summary .dialog-content');
  list.scrollTop = list.scrollHeight;
  return {
    scrolls: list.scrollHeight > list.clientHeight + 1,
    listBottom: box('.dialog-content').bottom,
    lastBottom: box('.dialog-content > :last-child').bottom,
    answersTop: box('.answers').top,
    answersBottom: box('.answers').bottom,
  };
}

/** Share of the window that no panel covers, and controls that cannot be brought into it. */
function layout() {
  // They go by themselves.
  document.querySelectorAll('.toast').forEach((t) => t.remove());
  const box = (e) => e.getBoundingClientRect();
  const visible = (e) => e.checkVisibility({ opacityProperty: true });
  const panels = [...document.querySelectorAll('.panel, .touch button, .tabs button')].filter(visible).map(box);
  let free = 0;
  const steps = 60;
  for (let i = 0; i < steps; i++)
    for (let j = 0; j < steps; j++) {
      const x = ((i + 0.5) / steps) * innerWidth;
      const y = ((j + 0.5) / steps) * innerHeight;
      if (!panels.some((p) => x >= p.left && x <= p.right && y >= p.top && y <= p.bottom)) free++;
    }
  const lost = [];
  for (const e of document.querySelectorAll('button, select, input')) {
    if (!visible(e)) continue;
    e.scrollIntoView({ block: 'nearest', inline: 'nearest' });
    const b = box(e);
    const at = document.elementFromPoint((b.left + b.right) / 2, (b.top + b.bottom) / 2);
    if (!at || !(e.contains(at) || at.contains(e))) lost.push(e.title || e.textContent);
  }
  return { free: free / steps ** 2, lost };
}
