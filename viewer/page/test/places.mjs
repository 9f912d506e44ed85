// SPDX-License-Identifier: GPL-3.0-or-later
// The pages as the checks of languages, access and keys open them: the session's page and the page of recorded
// sessions from the mock server, the others with the answers of a gateway that are written in place_answers.mjs.
import { readFileSync } from 'node:fs';
import { startMock } from '../scripts/mock-server.mjs';
import { patience } from './browser.mjs';
import { placeAnswers } from './place_answers.mjs';
import { pictureOf } from './shipped_exercises.mjs';

/** What a page tells the gateway changes what is answered later. */
function take(answers, what, body) {
  if (what === 'people') answers.people.push(body);
  if (what === 'choose') Object.assign(answers.state, { state: 'running', text: '' }, body);
}

/** A gateway's answers for the pages of the mock server, which has none. */
export async function answerStart(context) {
  const answers = placeAnswers();
  const pictures = new Map(answers.exercises.map((e) => [e.scene, pictureOf(e.scene)]));
  await context.route('**/api/**', (route) => {
    const url = new URL(route.request().url());
    const what = url.pathname.split('/').pop();
    const picture = what === 'picture' && pictures.get(url.searchParams.get('scene'));
    if (route.request().method() === 'POST') take(answers, what, route.request().postDataJSON());
    if (picture) return route.fulfill({ contentType: 'image/jpeg', body: readFileSync(picture) });
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
