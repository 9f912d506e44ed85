// SPDX-License-Identifier: GPL-3.0-or-later
// The page of recorded sessions: replay.html?session=NAME [&with=NAME] [&ghost=NAME] [&t=SECONDS] [&quality=LEVEL]
// [&debrief] [&cues=off]. `with` stands beside it in step. The tools of `ghost` are drawn over it. `debrief` begins
// with the page to print. `cues=off` leaves out plumb lines and marks. Without a session it asks for one.
import '../hud/styles';
import './replay.css';
import { el } from '../hud/dom';
import { type QualityName, qualityNames } from '../options';
import { BlobSource } from './byte_source';
import { openGhost } from './live_ghost';
import { openingPanel } from './opening';
import { Replay, reasonOf } from './replay';
import { RecordedSession } from './session';
import { Side } from './side';
import { type ListedSession, listSessions, sessionOf } from './source';
import { text } from '../languages/text';

document.title = `Insula: ${text('recorded session')}`;
const query = new URLSearchParams(location.search);
const quality: QualityName | null = qualityNames.find((n) => n === query.get('quality')) ?? null;
const sides = document.getElementById('sides')!;
const hud = document.getElementById('hud')!;

async function named(name: string): Promise<RecordedSession> {
  return RecordedSession.open(name, await sessionOf(name));
}

async function open(session: RecordedSession, kept: boolean): Promise<void> {
  const other = query.get('with');
  const ghost = query.get('ghost');
  const shown = [new Side(session, quality)];
  if (other) shown.push(new Side(await named(other), quality));
  for (const s of shown) s.view.cues = query.get('cues') !== 'off';
  if (ghost) shown[0]!.ghost = await openGhost(ghost);
  sides.replaceChildren(...shown.map((s) => s.root));
  for (const s of shown) await s.open();
  hud.replaceChildren();
  document.title = `Insula: ${session.title || session.name}`;
  new Replay(hud, shown, kept, query).begin();
}

async function ask(problem = ''): Promise<void> {
  let sessions: ListedSession[] = [];
  try {
    sessions = await listSessions();
  } catch (e) {
    problem ||= text('Recordings of this machine cannot be listed: {why}', { why: reasonOf(e) });
  }
  const panel = openingPanel(sessions, problem, {
    title: text('Which session?'),
    named: (name) => {
      query.set('session', name);
      location.search = query.toString();
    },
    file: (file) => void openFile(file),
  });
  hud.replaceChildren(panel);
}

async function openFile(file: File): Promise<void> {
  try {
    const name = file.name.replace(/\.(insula|mcap)$/, '');
    await open(await RecordedSession.open(name, new BlobSource(file)), false);
  } catch (e) {
    await ask(`${file.name}: ${reasonOf(e)}`);
  }
}

const wanted = query.get('session');
if (wanted === null) await ask();
else {
  hud.replaceChildren(el('div', { class: 'banner', role: 'status' }, text('Opening {name} …', { name: wanted })));
  try {
    await open(await named(wanted), true);
  } catch (e) {
    await ask(`${wanted}: ${reasonOf(e)}`);
  }
}
