// SPDX-License-Identifier: GPL-3.0-or-later
// The browser of the end-to-end tests: headless Chromium with software rendering, or with INSULA_BROWSER=firefox
// Firefox. Exit status 77: none here, skipped.
import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { chromium } from 'playwright-core';
import { launchFirefox } from './firefox.mjs';

/** Software rendering is slow; INSULA_PATIENCE_MS is for those who wait for a failing test. */
export const patience = { timeout: Number(process.env.INSULA_PATIENCE_MS ?? 300_000), polling: 250 };

/** more: further arguments of Chromium. */
export function launch(...more) {
  if (process.env.INSULA_BROWSER === 'firefox') return launchFirefox();
  const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';
  if (!existsSync(executablePath)) {
    console.log(`skipped: no browser at ${executablePath}`);
    process.exit(77);
  }
  return chromium.launch({
    executablePath,
    args: [
      '--no-sandbox',
      '--use-gl=angle',
      '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader',
      '--ignore-gpu-blocklist',
      ...more,
    ],
  });
}

/** A click by the page itself: on a slow machine a pointer's click waits for pictures. */
export const click = (page, selector) => page.evaluate((s) => document.querySelector(s).click(), selector);

export const check = (text) => console.log(`ok  ${text}`);

export async function waitFor(what, test) {
  for (let k = 0; k < 400; k++) {
    if (await test()) return;
    await new Promise((r) => setTimeout(r, 100));
  }
  assert.fail(`no ${what} within 40 s`);
}

/**
 * Mean brightness, its deviation, and shares of reddish, greenish and dark red pixels of the picture, without the
 * panels over it; disc: only of the disc in the clip. spread: contrast of its dimmer third. A mirror only adds light,
 * so that is the contrast of what lies below a reflecting surface.
 */
export async function look(page, clip, { disc = false } = {}) {
  const panels = (shown) =>
    page.evaluate(
      (o) => {
        document.getElementById('hud').style.opacity = o;
      },
      shown ? '1' : '0',
    );
  await panels(false);
  const shot = await page.screenshot({ ...(clip ? { clip } : {}), timeout: patience.timeout });
  await panels(true);
  return page.evaluate(
    async ([base64, disc]) => {
      const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
      const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
      context.drawImage(image, 0, 0);
      const d = context.getImageData(0, 0, image.width, image.height).data;
      const w = image.width;
      const h = image.height;
      const brightness = [];
      let mean = 0;
      let square = 0;
      let red = 0;
      let green = 0;
      let darkRed = 0;
      for (let i = 0; i < d.length; i += 4) {
        const k = i / 4;
        if (disc && Math.hypot(((k % w) + 0.5) / w - 0.5, (Math.floor(k / w) + 0.5) / h - 0.5) > 0.5) continue;
        const y = (d[i] + d[i + 1] + d[i + 2]) / 3;
        brightness.push(y);
        mean += y;
        square += y * y;
        if (d[i] > d[i + 2] + 15) red++;
        if (d[i + 1] > 60 && d[i + 1] > d[i] + 15) green++;
        if (d[i] > 25 && d[i] > 3 * Math.max(d[i + 1], d[i + 2])) darkRed++;
      }
      const n = brightness.length;
      brightness.sort((a, b) => a - b);
      const quantile = (q) => brightness[Math.floor(q * n)];
      return {
        spread: quantile(0.35) - quantile(0.05),
        mean: mean / n,
        deviation: Math.sqrt(square / n - (mean / n) ** 2),
        red: red / n,
        green: green / n,
        dark_red: darkRed / n,
      };
    },
    [shot.toString('base64'), disc],
  );
}
