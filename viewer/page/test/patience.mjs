// SPDX-License-Identifier: GPL-3.0-or-later
// Waits for what another program does.
import assert from 'node:assert/strict';

export async function waitFor(what, test) {
  for (let k = 0; k < 400; k++) {
    if (await test()) return;
    await new Promise((r) => setTimeout(r, 100));
  }
  assert.fail(`no ${what} within 40 s`);
}
