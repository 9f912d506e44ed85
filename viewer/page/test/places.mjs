// SPDX-License-Identifier: GPL-3.0-or-later
// The pages as the checks of languages, access and layout open them: the session's page and the page of recorded
// sessions from the mock server, the start page with the answers of a gateway that are written here.
import { startMock } from '../scripts/mock-server.mjs';
import { patience } from './browser.mjs';

const run = {
  uuid: 'a',
  scene: 'scenes/training/3_clipping.xml',
  title: 'Clipping',
  mode: 'practice',
  began_ms: 1_770_000_000_000,
  duration_s: 185,
  state: 'failed',
  goals: 3,
  goals_done: 1,
  faults: 2,
  recording: 'clipping',
};
const exercise = (scene, group, title, text) => ({ scene, group, title, text, picture: false });
const points = [3.4, 2.9, 2.2].map((value, k) => ({
  uuid: `${k}`,
  began_ms: 1e12 + k,
  mode: 'test',
  done: true,
  value,
}));
const curve = { metric: 'a', hand: 'left', text: 'Largest force', unit: 'N', better: 'low', digits: 2, points };

const answers = {
  exercises: [
    exercise('scenes/skills/1_touch_targets.xml', 'skills', 'Touch targets in depth', 'Look at the shadow.'),
    exercise(run.scene, 'training', 'Clipping', 'Close the neck and keep both branches open'),
    exercise('scenes/training/4_rupture.xml', 'training', 'Rupture', 'Stop the bleeding'),
  ],
  people: [{ pseudonym: 'P07', role: 'resident', handedness: 'right', year: 3 }],
  history: [{ scene: run.scene, title: run.title, runs: 2, last: run, best: { ...run, uuid: 'b', state: 'done' } }],
  curves: [curve],
  state: { scene: run.scene, person: '', state: 'running', text: '' },
};

/** A gateway's answers for the start page of the mock server, which has none. */
export async function answerStart(context) {
  await context.route('**/api/*', (route) => {
    const what = new URL(route.request().url()).pathname.split('/').pop();
    return route.fulfill({ json: answers[what] ?? {} });
  });
  await context.route('**/sessions', (route) => route.fulfill({ json: [{ name: 'clipping', bytes: 2_500_000 }] }));
}

/** mode: of the session; "waiting" asks the page for one. */
export const startPlaces = (mode = '') => startMock({ port: 0, startS: 1, mode });

export async function openStart(page, url) {
  await page.goto(`${url}start.html`);
  await page.waitForSelector('.card', patience);
}

export async function openSession(page, url, query = '') {
  await page.goto(`${url}index.html?quality=draft${query}`);
  await page.waitForFunction(() => window.__insula?.ready, null, patience);
}

export async function openRecordings(page, url) {
  await page.goto(`${url}replay.html`);
  await page.waitForSelector('.opening', patience);
}
