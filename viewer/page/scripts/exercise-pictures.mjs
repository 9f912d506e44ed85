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
const width = 1200;
const height = 1100;

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
  const page = await browser.newPage({ viewport: { width, height } });
  page.setDefaultTimeout(patience.timeout);
  await page.goto(`${address}&t=${timeS}&quality=high&cues=off`);
  await page.locator('canvas').first().waitFor();
  await page.waitForTimeout(Number(process.env.INSULA_PICTURE_WAIT_MS ?? 15_000));
  // The field alone: the widest part of the picture that lies inside of the microscope's disc.
  await page.addStyleTag({
    content: '* { visibility: hidden !important } canvas { visibility: visible !important }',
  });
  const box = await page.locator('canvas').first().boundingBox();
  const high = 0.49 * Math.min(box.width, box.height);
  const wide = (high * 16) / 9;
  const clip = { x: box.x + (box.width - wide) / 2, y: box.y + (box.height - high) / 2, width: wide, height: high };
  const path = scene.replace(/\.xml$/, '.jpg');
  await page.screenshot({ path, clip, type: 'jpeg', quality: 80, timeout: patience.timeout });
  await page.close();
  gateway.kill('SIGINT');
  rmSync(folder, { recursive: true });
  console.log(path);
}

const browser = await launch();
for (let i = 2; i + 1 < process.argv.length; i += 2) await take(browser, process.argv[i], process.argv[i + 1]);
await browser.close();
