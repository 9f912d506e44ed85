// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of exercises for the start page: NAME.jpg beside each scene, from its steady motion at the given time.
//   node scripts/exercise-pictures.mjs SCENE TIME_S [SCENE TIME_S ...]
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { launch, patience } from '../test/browser.mjs';

const root = fileURLToPath(new URL('../../..', import.meta.url));
const programs = join(root, 'build/release/bin');
const width = 960;
const height = 540;

async function take(browser, scene, timeS) {
  const folder = mkdtempSync(join(tmpdir(), 'insula_picture_'));
  const file = join(folder, 'run.insula');
  const duration = `${Number(timeS) + 0.5} s`;
  const words = ['run', scene, '--motion', 'steady', '--duration', duration, '--record', file, '--quiet'];
  execFileSync(join(programs, 'insula'), words, { stdio: 'ignore' });
  const dist = join(root, 'viewer/page/dist');
  const gateway = spawn(join(programs, 'gateway'), ['--page', dist, '--port', '0', '--session', file], {
    env: { ...process.env, LCM_DEFAULT_URL: 'memq://' },
  });
  const address = await new Promise((resolve) =>
    gateway.stdout.on('data', (d) => {
      const found = /recorded sessions at (\S+)/.exec(d);
      if (found) resolve(found[1]);
    }),
  );
  const page = await browser.newPage({ viewport: { width, height }, deviceScaleFactor: 0.75 });
  await page.goto(`${address}&t=${timeS}&quality=high`);
  await page.waitForTimeout(15_000);
  await page.evaluate(() => {
    document.getElementById('hud').style.opacity = '0';
  });
  const path = scene.replace(/\.xml$/, '.jpg');
  await page.screenshot({ path, type: 'jpeg', quality: 80, timeout: patience.timeout });
  await page.close();
  gateway.kill('SIGINT');
  rmSync(folder, { recursive: true });
  console.log(path);
}

const browser = await launch();
for (let i = 2; i + 1 < process.argv.length; i += 2) await take(browser, process.argv[i], process.argv[i + 1]);
await browser.close();
