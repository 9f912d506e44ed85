// SPDX-License-Identifier: GPL-3.0-or-later
// Twenty stations on one machine: real gateways and recorded engines, and an overview that asks them all and
// opens one. Exit status 77: no browser, no programs or no multicast, skipped.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { check, launch, patience } from './browser.mjs';
import { recorder } from './recorded_engine.mjs';

const count = 20;
const root = fileURLToPath(new URL('../../..', import.meta.url));
const programs = join(root, 'build/release/bin');
if (!existsSync(join(programs, 'gateway'))) {
  console.log(`skipped: no programs in ${programs}`);
  process.exit(77);
}
const began = performance.now();
const folder = mkdtempSync(join(tmpdir(), 'insula_room_'));
const children = [];
const firstBus = 20000 + ((process.pid * 23) % 20000);

function start(program, words, bus) {
  const env = { ...process.env, LCM_DEFAULT_URL: bus };
  const child = spawn(join(programs, program), words, { cwd: root, env, stdio: ['ignore', 'pipe', 'pipe'] });
  children.push(child);
  return child;
}

/** The address that a gateway prints. */
function gateway(words, bus) {
  const child = start('gateway', ['--port', '0', ...words], bus);
  return new Promise((resolve) => {
    let said = '';
    for (const out of [child.stdout, child.stderr])
      out.on('data', (d) => {
        said += d;
        const found = /serving (\S+)/.exec(said);
        if (found) resolve(found[1]);
      });
    child.once('exit', (status) => {
      if (ended) return;
      console.log(`skipped: the gateway ended with ${status}: ${said}`);
      process.exit(77);
    });
  });
}

let ended = false;
const browser = await launch();
try {
  const record = await recorder({ folder, seconds: 4, rate: 10 });
  const urls = await Promise.all(
    Array.from({ length: count }, (_, k) => {
      const bus = `udpm://239.255.76.67:${firstBus + k}?ttl=0`;
      start('insula', ['replay', record(`Exercise ${k + 1}`), '--loop'], bus);
      return gateway(['--station', `table ${k + 1}`], bus);
    }),
  );
  writeFileSync(join(folder, 'stations'), urls.map((u, k) => `Table_${k + 1} ${u}`).join('\n'));
  const desk = await gateway(['--stations', join(folder, 'stations')], 'memq://');
  const page = await browser.newPage({ viewport: { width: 1366, height: 1100 } });
  await page.goto(`${desk}room.html`);
  await page.getByText(`${count} of ${count} stations answer`).waitFor(patience);
  const alarmed = page.locator('.station[data-standing=alarm]');
  await page.waitForFunction((n) => document.querySelectorAll('[data-standing=alarm]').length === n, count, patience);
  for (let k = 0; k < count; k++) {
    const card = await alarmed.nth(k).innerText();
    assert.match(card, new RegExp(`Table_${k + 1}\\b[^]*Exercise ${k + 1}\\b[^]*torn at Exercise ${k + 1}\\b`));
  }
  check(`the overview shows ${count} stations with their exercise and alarms`);

  // A trainee's page with a plain picture; this machine draws it without a graphics card.
  const trainee = await browser.newPage({ viewport: { width: 480, height: 270 } });
  await trainee.goto(`${urls[6]}?quality=draft`);
  await trainee.waitForFunction(() => window.__insula?.ready, null, patience);
  await page.locator('.station').nth(6).locator('img:not([hidden])').waitFor(patience);
  const shown = await page
    .locator('.station')
    .nth(6)
    .locator('img')
    .evaluate((i) => i.decode().then(() => i.naturalWidth));
  assert.equal(shown, 320);
  check('the picture of a trainee who works arrives in the overview');

  const [instructor] = await Promise.all([
    page.waitForEvent('popup'),
    page.locator('.station').nth(6).getByRole('button', { name: 'Open' }).click(),
  ]);
  await instructor.waitForURL(/role=instructor/, patience);
  assert.ok(instructor.url().startsWith(urls[6]), 'the page of that station');
  check('a station opens from the overview');
  assert.ok(performance.now() - began < 300_000, 'it takes less than five minutes on a machine that others use too');
} finally {
  ended = true;
  await browser.close();
  for (const child of children) child.kill('SIGTERM');
  rmSync(folder, { recursive: true, force: true });
}
