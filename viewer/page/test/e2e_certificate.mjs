// SPDX-License-Identifier: GPL-3.0-or-later
// From first use to certificate with no terminal: the real programs in headless Chromium. Exit status 77: no browser,
// no programs or no multicast, skipped.
import assert from 'node:assert/strict';
import { launch } from './browser.mjs';
import { FirstUse, walkToCertificate } from './first_use/walk.mjs';

const browser = await launch();
const place = await new FirstUse().open();
try {
  const page = await browser.newPage({ viewport: { width: 1366, height: 768 } });
  const errors = [];
  page.on('pageerror', (e) => errors.push(e.message));
  await walkToCertificate(page, place);
  assert.deepEqual(errors, []);
} finally {
  await browser.close();
  await place.end();
}
