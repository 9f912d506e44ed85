// SPDX-License-Identifier: GPL-3.0-or-later
// The overview of a room: a card for each station, asked for once a second.
import './room.css';
import '../screens.css';
import { el, setText } from '../hud/dom';
import { text } from '../languages/text';
import { StationCard } from './cards';
import { standingOf, stationsOf } from './overview';

document.title = `Insula: ${text('The room')}`;
const everyMs = 1000;
const base = new URL('./', window.location.href);
const say = el('p', { class: 'say', role: 'status' });
const grid = el('div', { class: 'stations' });
document.getElementById('room')!.append(el('header', { class: 'top' }, el('h1', {}, text('The room')), say), grid);
const cards: StationCard[] = [];

/** A window of its own is opened at the click, before the gateway has answered, or the browser would block it. */
async function open(station: number): Promise<void> {
  const page = window.open('about:blank', `insula_station_${station}`);
  try {
    const answer = await fetch(new URL(`api/room/open?station=${station}`, base), { method: 'POST' });
    const { url } = (await answer.json()) as { url?: unknown };
    if (!answer.ok || typeof url !== 'string' || !/^https?:\/\//.test(url)) throw new Error(String(answer.status));
    if (page) page.location.href = url;
  } catch {
    page?.close();
    setText(say, text('This station cannot be opened.'));
  }
}

async function look(): Promise<void> {
  const answer = await fetch(new URL('api/room', base));
  if (!answer.ok) throw new Error(String(answer.status));
  const stations = stationsOf(await answer.json());
  stations.forEach((s, k) => {
    if (!cards[k]) {
      const pictureUrl = (n: number) => new URL(`api/room/picture?station=${k}&number=${n}`, base).href;
      cards[k] = new StationCard(s.name, pictureUrl, () => void open(k));
      grid.append(cards[k].root);
    }
    cards[k].show(s);
  });
  const good = stations.filter((s) => standingOf(s) !== 'away').length;
  setText(
    say,
    stations.length === 0
      ? text('No stations are listed. Start this gateway with a list of stations.')
      : text('{good} of {count, plural, one {# station answers} other {# stations answer}}', {
          good,
          count: stations.length,
        }),
  );
}

async function follow(): Promise<void> {
  try {
    await look();
  } catch {
    setText(say, text('The gateway does not answer.'));
  }
  window.setTimeout(() => void follow(), everyMs);
}
void follow();
