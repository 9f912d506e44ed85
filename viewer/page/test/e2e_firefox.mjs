// SPDX-License-Identifier: GPL-3.0-or-later
// The real programs in Firefox: from first use to certificate with no terminal, with a look at a live exercise on the
// way; all by TLS. Exit status 77: no Firefox, or no screen and sound device for it, no programs or no multicast,
// skipped.
import assert from 'node:assert/strict';
import { check } from './browser.mjs';
import { launchFirefox } from './firefox.mjs';
import { liveExercise } from './first_use/live.mjs';
import { FirstUse, walkToCertificate } from './first_use/walk.mjs';

/** A page that has WebGL 2: Firefox and its screen are here, so it must. */
async function newPage(browser) {
  const page = await browser.newPage({ viewport: { width: 1366, height: 768 }, ignoreHTTPSErrors: true });
  const drawnBy = await page.evaluate(() => {
    const context = document.createElement('canvas').getContext('webgl2');
    return context && context.getParameter(context.RENDERER);
  });
  assert.ok(drawnBy, 'WebGL 2 comes up');
  check(`Firefox ${browser.version()} draws by WebGL 2 (${drawnBy})`);
  return page;
}

const browser = await launchFirefox();
const place = await new FirstUse().open('--tls');
try {
  const page = await newPage(browser);
  const errors = [];
  page.on('pageerror', (e) => errors.push(e.message));
  await walkToCertificate(page, place, liveExercise);
  assert.deepEqual(errors, []);
} finally {
  await browser.close();
  await place.end();
}
