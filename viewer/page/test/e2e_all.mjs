// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the browser checks one after the other, and says at the end which failed. Exit status: 1 if one failed, 77 if
// all were skipped (no browser, no programs or no multicast), else 0. Names as arguments run those alone:
// `node test/e2e_all.mjs start room`.
import { spawnSync } from 'node:child_process';
import { argv, execPath, exit } from 'node:process';
import { fileURLToPath } from 'node:url';

const checks = [
  'page',
  'session',
  'vessel',
  'data',
  'budget',
  'timbre',
  'sound',
  'replay',
  'start',
  'tour',
  'skills',
  'room',
  'desk',
  'voice',
  'layout',
  'access',
  'keyboard',
  'certificate',
  'studio',
  'scene_editor',
  'scan',
  'firefox',
  'sound_firefox',
];
const skipped = 77;
/** A check that hangs must not keep the others from running. */
const longestS = 720;

const asked = argv.slice(2);
const unknown = asked.filter((name) => !checks.includes(name));
if (unknown.length > 0) {
  console.error(`error: no check ${unknown.join(', ')}; there are ${checks.join(', ')}`);
  exit(2);
}

const ends = (asked.length > 0 ? asked : checks).map((name) => {
  const began = performance.now();
  const file = fileURLToPath(new URL(name === 'page' ? 'e2e.mjs' : `e2e_${name}.mjs`, import.meta.url));
  console.log(`\n${name}`);
  const status = spawnSync(execPath, [file], { stdio: 'inherit', timeout: 1000 * longestS }).status ?? 1;
  return { name, status, seconds: (performance.now() - began) / 1000 };
});

const word = (status) => (status === 0 ? 'ok' : status === skipped ? 'skipped' : 'FAILED');
console.log('');
for (const { name, status, seconds } of ends) console.log(`${word(status).padEnd(8)} ${name}, ${seconds.toFixed(0)} s`);
if (ends.some((e) => e.status !== 0 && e.status !== skipped)) exit(1);
if (ends.every((e) => e.status === skipped)) exit(skipped);
