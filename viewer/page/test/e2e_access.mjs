// SPDX-License-Identifier: GPL-3.0-or-later
// Whether everybody can read the pages: axe finds nothing against WCAG 2 A and AA, contrast included.
// Exit status 77: no browser, skipped.
import assert from 'node:assert/strict';
import { axeFinds } from './axe.mjs';
import { check, launch, patience } from './browser.mjs';
import { answerStart, openRecordings, openSession, openStart, startPlaces } from './places.mjs';

const browser = await launch();
const mock = await startPlaces();
const waiting = await startPlaces('waiting');
const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
await answerStart(context);

/** What is broken, by page. */
const broken = [];

/** Nothing of WCAG 2 A and AA is broken. */
async function accessible(page, where) {
  const found = await axeFinds(page);
  for (const what of found) broken.push(`${where}: ${what}`);
  if (found.length > 0) console.log(`bad ${where}: ${found.join('\n')}`);
  else check(`${where}: axe finds nothing against WCAG 2 A and AA`);
}

async function axeEverywhere() {
  const page = await context.newPage();
  await openStart(page, mock.url);
  await accessible(page, 'start page');
  await page.getByRole('button', { name: 'Add a person' }).click();
  await accessible(page, 'form of a person');
  await page.getByRole('button', { name: 'Cancel' }).click();
  await page
    .getByRole('button', { name: /^Progress/ })
    .first()
    .click();
  await accessible(page, 'learning curves');
  await openRecordings(page, mock.url);
  await accessible(page, 'choice of a recording');
  for (const role of ['trainee', 'instructor', 'observer']) {
    await openSession(page, mock.url, `&role=${role}`);
    await accessible(page, `session, ${role}`);
  }
  await openSession(page, mock.url);
  await page.keyboard.press('h');
  await accessible(page, 'help');
  await openSession(page, waiting.url);
  await page.waitForSelector('.dialog.start:not([hidden])', patience);
  await accessible(page, 'choice of a mode');
  await page.close();
}

try {
  await axeEverywhere();
  assert.equal(broken.join('\n'), '');
} finally {
  await browser.close();
  await Promise.all([mock.stop(), waiting.stop()]);
}
