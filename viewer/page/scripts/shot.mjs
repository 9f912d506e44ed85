// SPDX-License-Identifier: GPL-3.0-or-later
// Screenshots of the page against the mock server: node scripts/shot.mjs OUT.png [--at SECONDS] [--query
// "quality=high"] [--size 1280x720] [--wheel CLICKS] [--url http://...] [--script '{"rupture": 8}'] [--turn DX,DY]
// [--pan DX,DY] [--keys i,l] [--wait SECONDS]
import { chromium } from 'playwright-core';
import { startMock } from './mock-server.mjs';

const option = (name, otherwise) => {
  const i = process.argv.indexOf(name);
  return i < 0 ? otherwise : process.argv[i + 1];
};
const browserArguments = [
  '--no-sandbox',
  '--use-gl=angle',
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
  '--ignore-gpu-blocklist',
];

const [width, height] = option('--size', '1280x720').split('x').map(Number);
// Software rendering of a large picture on a busy machine takes its time.
const patience = { timeout: 600_000, polling: 500 };
const at = Number(option('--at', '9'));
// --url: a running gateway instead of the mock.
const mock = option('--url', '')
  ? null
  : await startMock({ port: 0, startS: Math.max(0, at - 3), script: JSON.parse(option('--script', '{}')) });
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: browserArguments,
});
const page = await browser.newPage({ viewport: { width, height } });
page.on('console', (m) => {
  if (m.type() !== 'log') console.log(`[${m.type()}]`, m.text().slice(0, 2000));
});
page.on('pageerror', (e) => console.log('[page error]', e.message));
await page.goto(`${mock?.url ?? option('--url')}?t=${at}&${option('--query', 'quality=high')}`);
await page.waitForFunction(() => window.__insula?.frozen, null, patience);
const setup = option('--run', '');
if (setup) await page.evaluate(setup);
const wheel = Number(option('--wheel', '0'));
if (wheel) {
  await page.mouse.move(width / 2, height / 2);
  for (let i = 0; i < Math.abs(wheel); i++) await page.mouse.wheel(0, 100 * Math.sign(wheel));
}
for (const [name, button] of [
  ['--turn', 'right'],
  ['--pan', 'middle'],
]) {
  const [dx, dy] = option(name, '0,0').split(',').map(Number);
  if (!dx && !dy) continue;
  await page.mouse.move(width / 2, height / 2);
  await page.mouse.down({ button });
  await page.mouse.move(width / 2 + dx, height / 2 + dy, { steps: 2 });
  await page.mouse.up({ button });
}
for (const key of option('--keys', '')
  .split(',')
  .filter((k) => k))
  await page.keyboard.press(key);
await page.waitForTimeout(1000 * Number(option('--wait', '0')));
const from = await page.evaluate(() => window.__insula.pictures);
await page.waitForFunction((n) => window.__insula.pictures > n + 8, from, patience);
await page.screenshot({ path: process.argv[2], timeout: patience.timeout });
console.log(JSON.stringify(await page.evaluate(() => window.__insula)));
await browser.close();
await mock?.stop();
