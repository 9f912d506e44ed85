// SPDX-License-Identifier: GPL-3.0-or-later
// Instructor and trainee talk by voice, with made-up microphones that beep, through a real gateway. Exit status 77: no
// browser or no programs, skipped.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { check, launch, patience } from './browser.mjs';
import { Programs } from './programs.mjs';
import { recorder } from './recorded_engine.mjs';

const programs = new Programs();
const folder = mkdtempSync(join(tmpdir(), 'insula_voice_'));
const bus = `udpm://239.255.76.67:${20000 + ((process.pid * 23) % 20000)}?ttl=0`;
const browser = await launch(
  '--use-fake-device-for-media-stream',
  '--use-fake-ui-for-media-stream',
  '--autoplay-policy=no-user-gesture-required',
);

async function open(url, role) {
  const page = await browser.newPage({ viewport: { width: 640, height: 360 } });
  await page.addInitScript(() => {
    window.__asked = [];
    const devices = navigator.mediaDevices;
    const ask = devices?.getUserMedia.bind(devices);
    if (devices)
      devices.getUserMedia = (wanted) => {
        window.__asked.push(wanted);
        return ask(wanted);
      };
  });
  await page.goto(`${url}?quality=draft&role=${role}`);
  await page.waitForFunction(() => window.__insula?.ready, null, patience);
  return page;
}
const press = async (page, label) => {
  const found = () =>
    page.evaluate((l) => {
      const b = [...document.querySelectorAll('.voice button')].find((x) => x.textContent === l && !x.hidden);
      if (!b || b.disabled) return false;
      b.click();
      return true;
    }, label);
  for (let k = 0; k < 400; k++) {
    if (await found()) return;
    await new Promise((r) => setTimeout(r, 100));
  }
  assert.fail(`no button ${label}`);
};
const state = (page, wanted) => page.waitForFunction((s) => window.__insula.voice.state === s, wanted, patience);
const energy = (page) => page.evaluate(() => window.__insula.voice.energy);
/** Energy of the sound that comes within five seconds. */
async function heard(page) {
  const before = await energy(page);
  for (let k = 0; k < 100; k++) {
    await new Promise((r) => setTimeout(r, 100));
    if ((await energy(page)) > before + 1e-4) return (await energy(page)) - before;
  }
  return (await energy(page)) - before;
}
const sign = (page) => page.evaluate(() => document.querySelector('.voice-sign:not([hidden])')?.textContent ?? '');
const asked = (page) => page.evaluate(() => window.__asked);
const shot = async (page, name) => {
  if (process.env.INSULA_SHOTS) await page.screenshot({ path: join(process.env.INSULA_SHOTS, name), ...patience });
};

try {
  const record = await recorder({ folder, seconds: 4, rate: 10 });
  programs.start('insula', ['replay', record('Exercise'), '--loop'], bus);
  const url = await programs.gateway([], bus);
  const trainee = await open(url, 'trainee');
  const instructor = await open(url, 'instructor');

  await press(instructor, 'Talk by voice');
  await state(trainee, 'ringing');
  assert.match(await sign(trainee), /Instructor wants to talk/);
  assert.equal((await asked(trainee)).length, 0, 'the microphone is asked for only when it is needed');
  await shot(trainee, 'voice_ringing.png');
  await press(trainee, 'Accept');
  await Promise.all([state(trainee, 'open'), state(instructor, 'open')]);
  for (const page of [trainee, instructor]) {
    assert.equal(await sign(page), 'Your microphone is open');
    assert.equal((await asked(page))[0].audio.echoCancellation, true);
    assert.equal((await asked(page))[0].video, false);
  }
  const [atTrainee, atInstructor] = await Promise.all([heard(trainee), heard(instructor)]);
  assert.ok(atTrainee > 1e-4 && atInstructor > 1e-4, `${atTrainee}, ${atInstructor}`);
  console.log(`sound energy: trainee ${atTrainee.toExponential(1)}, instructor ${atInstructor.toExponential(1)}`);
  await shot(trainee, 'voice_trainee.png');
  await shot(instructor, 'voice_instructor.png');
  check('each side hears the other');

  await press(trainee, 'Mute');
  assert.equal(await sign(trainee), 'Your microphone is muted');
  await new Promise((r) => setTimeout(r, 1500));
  assert.ok((await heard(instructor)) < 1e-4, 'nothing is heard of who is muted');
  check('who is muted is not heard');

  await trainee.close();
  await state(instructor, 'off');
  assert.equal(await sign(instructor), '');
  check('it ends when one leaves');

  const again = await open(url, 'trainee');
  await press(again, 'Talk by voice');
  await state(instructor, 'ringing');
  await press(instructor, 'Decline');
  await state(again, 'off');
  await again.getByText('The other side does not talk now.').waitFor({ ...patience, state: 'attached' });
  check('a trainee rings too, and the other side may decline');
} finally {
  await browser.close();
  await programs.end();
  rmSync(folder, { recursive: true, force: true });
}
