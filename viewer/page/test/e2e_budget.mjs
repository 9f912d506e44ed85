// SPDX-License-Identifier: GPL-3.0-or-later
// What a picture costs, against the budget of a mid-range laptop's graphics (docs/trainee.md): triangles and draw
// calls as the renderer counts them, and the bytes of all textures, targets and buffers as they are asked of WebGL.
// And what the start page loads before anything is chosen.
import assert from 'node:assert/strict';
import { startMock } from '../scripts/mock-server.mjs';
import { check, launch, patience } from './browser.mjs';
import { answerStart, openStart } from './places.mjs';

const budget = { triangles: 400_000, calls: 120, fixed_mb: 60, bytes_per_pixel: 160 };
const view = { width: 480, height: 270 };
/** Of the start page's scripts, unpacked. It draws no field. */
const startScripts = 150_000;

/** Keeps the size of everything that lies on the graphics card, by object, in window.__bytes. */
function countBytes() {
  const bytes = (window.__bytes = new Map());
  const sizes = { 0x8058: 4, 0x881a: 8, 0x8814: 16, 0x822d: 2, 0x81a5: 2, 0x81a6: 4, 0x8cac: 4, 0x88f0: 4, 0x8229: 1 };
  const bound = new Map();
  const p = WebGL2RenderingContext.prototype;
  const wrap = (name, after) => {
    const was = p[name];
    p[name] = function (...a) {
      after(a);
      return was.apply(this, a);
    };
  };
  const put = (target, size) => bytes.set(bound.get(target) ?? `unbound ${target}`, size);
  wrap('bindTexture', (a) => bound.set(a[0], a[1]));
  wrap('bindRenderbuffer', (a) => bound.set(a[0], a[1]));
  wrap('bindBuffer', (a) => bound.set(a[0], a[1]));
  wrap('deleteTexture', (a) => bytes.delete(a[0]));
  wrap('deleteRenderbuffer', (a) => bytes.delete(a[0]));
  wrap('deleteBuffer', (a) => bytes.delete(a[0]));
  const each = (format) => sizes[format] ?? 4;
  // A third more for the smaller pictures of a texture.
  wrap('texStorage2D', (a) => put(a[0], a[3] * a[4] * each(a[2]) * (a[1] > 1 ? 4 / 3 : 1)));
  wrap('texStorage3D', (a) => put(a[0], a[3] * a[4] * a[5] * each(a[2]) * (a[1] > 1 ? 8 / 7 : 1)));
  wrap('texImage2D', (a) => a.length === 9 && put(a[0], a[3] * a[4] * each(a[2])));
  wrap('renderbufferStorage', (a) => put(a[0], a[2] * a[3] * each(a[1])));
  wrap('renderbufferStorageMultisample', (a) => put(a[0], a[1] * a[3] * a[4] * each(a[2])));
  wrap('bufferData', (a) => put(a[0], typeof a[1] === 'number' ? a[1] : (a[1]?.byteLength ?? 0)));
}

/** Scripts of the start page, until its cards are there. */
async function startPage(browser, url) {
  const context = await browser.newContext();
  await answerStart(context);
  const page = await context.newPage();
  const scripts = [];
  page.on('response', (r) => r.request().resourceType() === 'script' && scripts.push(r));
  await openStart(page, url);
  const sizes = await Promise.all(scripts.map(async (r) => (await r.body()).length));
  const sum = sizes.reduce((a, b) => a + b, 0);
  assert.ok(sum > 20_000 && sum < startScripts, `${sum} bytes of scripts on the start page`);
  check(`the start page loads ${(sum / 1000).toFixed(0)} kB of scripts; ${startScripts / 1000} allowed`);
  await context.close();
}

/** --url: a running gateway instead of the mock. */
const at = process.argv.indexOf('--url');
const mock = at < 0 ? await startMock({ port: 0, startS: 3 }) : null;
const browser = await launch();
try {
  const page = await browser.newPage({ viewport: view });
  page.setDefaultTimeout(patience.timeout);
  await page.addInitScript(countBytes);
  await page.goto(`${mock?.url ?? process.argv[at + 1]}?quality=high&nohud`);
  await page.waitForFunction(() => window.__insula?.ready && window.__insula.pictures > 3, null, patience);
  const cost = await page.evaluate(() => ({
    triangles: window.__insula.triangles,
    calls: window.__insula.calls,
    bytes: [...window.__bytes.values()].reduce((sum, b) => sum + b, 0),
    pixels: (() => {
      const c = document.getElementById('view');
      return c.width * c.height;
    })(),
  }));
  assert.ok(cost.triangles > 50_000 && cost.triangles < budget.triangles, `${cost.triangles} triangles`);
  check(`${cost.triangles} triangles a picture, shadows included; ${budget.triangles} allowed`);
  assert.ok(cost.calls > 10 && cost.calls < budget.calls, `${cost.calls} draw calls`);
  check(`${cost.calls} draw calls; ${budget.calls} allowed`);
  const most = budget.fixed_mb * 1e6 + budget.bytes_per_pixel * cost.pixels;
  assert.ok(cost.bytes > 5e6 && cost.bytes < most, `${(cost.bytes / 1e6).toFixed(1)} MB`);
  check(
    `${(cost.bytes / 1e6).toFixed(1)} MB on the card for ${cost.pixels} pixels; ${(most / 1e6).toFixed(0)} allowed`,
  );
  if (mock) await startPage(browser, mock.url);
} finally {
  await browser.close();
  await mock?.stop();
}
