// SPDX-License-Identifier: GPL-3.0-or-later
// The overview of a room: a card for each station, asked for once a second.
import './room.css';
import '../screens.css';
import { el, setText } from '../hud/dom';
import { text } from '../languages/text';
import { AccessDialog } from './access_dialog';
import { StationCard } from './cards';
import { FoundStations } from './found_stations';
import { roomOf, standingOf, type StationView } from './overview';
import { change, type NewStation, StationForm } from './station_form';

document.title = `Insula: ${text('The room')}`;
const everyMs = 1000;
const base = new URL('./', window.location.href);
const say = el('p', { class: 'say', role: 'status' });
const grid = el('div', { class: 'stations' });
const cards = new Map<number, StationCard>();
const form = new StationForm((s: NewStation) => change(new URL('api/room/stations', base), 'POST', s).then(lookAfter));
const found = new FoundStations((s) => form.open(s.name, s.url));
const add = el('button', { type: 'button', class: 'add' }, text('Add a station'));
add.onclick = () => form.open();
const access = new AccessDialog(base);
const buttons = el('div', { class: 'buttons' }, access.button, add);
const top = el('header', { class: 'top' }, el('h1', {}, text('The room')), say, buttons);
document.getElementById('room')!.append(top, grid, found.root, form.root, access.root);

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

async function remove(s: StationView): Promise<void> {
  if (!window.confirm(text('Remove {name} from the list?', { name: s.name }))) return;
  const why = await change(new URL(`api/room/stations?station=${s.number}`, base), 'DELETE').then(lookAfter);
  if (why !== '') setText(say, why);
}

/** What was changed is shown at once. */
async function lookAfter(why: string): Promise<string> {
  if (why === '') await look().catch(() => undefined);
  return why;
}

function cardOf(s: StationView): StationCard {
  const known = cards.get(s.number);
  if (known) return known;
  const pictureUrl = (n: number) => new URL(`api/room/picture?station=${s.number}&number=${n}`, base).href;
  const take = s.given ? null : () => void remove(s);
  const card = new StationCard(s, pictureUrl, () => void open(s.number), take);
  cards.set(s.number, card);
  grid.append(card.root);
  return card;
}

async function look(): Promise<void> {
  const answer = await fetch(new URL('api/room', base));
  if (!answer.ok) throw new Error(String(answer.status));
  const room = roomOf(await answer.json());
  const { stations } = room;
  for (const s of stations) cardOf(s).show(s);
  for (const [number, card] of cards) {
    if (stations.some((s) => s.number === number)) continue;
    card.root.remove();
    cards.delete(number);
  }
  found.show(room);
  const good = stations.filter((s) => standingOf(s) !== 'away').length;
  setText(
    say,
    stations.length === 0
      ? text('No stations are listed yet.')
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
void access.offer();
