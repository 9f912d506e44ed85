// SPDX-License-Identifier: GPL-3.0-or-later
// Screenshots of the page against the mock server: node scripts/shot.mjs OUT.png [--at SECONDS] [--query "quality=high"] [--size 1280x720]
// [--wheel CLICKS] [--url http://...]
import { chromium } from 'playwright-core';
import { start_mock } from './mock-server.mjs';

const option = (name, otherwise) => { const i = process.argv.indexOf(name); return i < 0 ? otherwise : process.argv[i + 1]; };
const browser_arguments = ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];

const [width, height] = option('--size', '1280x720').split('x').map(Number);
// Software rendering of a large picture on a busy machine takes its time.
const patience = { timeout: 600_000, polling: 500 };
const at = Number(option('--at', '9'));
// --url: a running gateway instead of the mock.
const mock = option('--url', '') ? null : await start_mock({ port: 0, start_s: Math.max(0, at - 3) });
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: browser_arguments });
const page = await browser.newPage({ viewport: { width, height } });
page.on('console', (m) => { if (m.type() !== 'log') console.log(`[${m.type()}]`, m.text().slice(0, 2000)); });
page.on('pageerror', (e) => console.log('[page error]', e.message));
await page.goto(`${mock?.url ?? option('--url')}?t=${at}&${option('--query', 'quality=high')}`);
await page.waitForFunction(() => window.__insula?.frozen, null, patience);
const setup = option('--run', '');
if (setup) await page.evaluate(setup);
const wheel = Number(option('--wheel', '0'));
if (wheel) { await page.mouse.move(width / 2, height / 2); for (let i = 0; i < Math.abs(wheel); i++) await page.mouse.wheel(0, 100 * Math.sign(wheel)); }
const from = await page.evaluate(() => window.__insula.pictures);
await page.waitForFunction((n) => window.__insula.pictures > n + 8, from, patience);
await page.screenshot({ path: process.argv[2], timeout: patience.timeout });
console.log(JSON.stringify(await page.evaluate(() => window.__insula)));
await browser.close();
await mock?.stop();
