// SPDX-License-Identifier: GPL-3.0-or-later
// A card for each station: picture, who, what, how long, and what went wrong.
import { el, setText } from '../hud/dom';
import { clockText } from '../hud/state';
import { said } from '../languages/said';
import { text } from '../languages/text';
import { type Standing, standingOf, type StationView } from './overview';

/** What is said of a station's standing; '': nothing. */
export function standingText(s: StationView, standing: Standing): string {
  if (standing === 'away') return text('does not answer: {why}', { why: s.error });
  if (standing === 'idle') return text('nothing runs');
  if (standing === 'silent') return text('the engine is silent');
  if (s.state === 'paused') return text('paused');
  return '';
}

/** An alarm that came several times is one line, with its last time. */
export function alarmLines(alarms: StationView['alarms']): string[] {
  const last = new Map<string, { timeS: number; count: number }>();
  for (const { text: what, timeS } of alarms) {
    const count = (last.get(what)?.count ?? 0) + 1;
    last.delete(what); // so that the latest stands last
    last.set(what, { timeS, count });
  }
  return [...last].map(
    ([what, { timeS, count }]) => `${clockText(timeS)} ${said(what)}${count > 1 ? ` ×${count}` : ''}`,
  );
}

/** Of a station: "192.0.2.7:8080". */
export const placeOf = (url: string): string => url.replace(/^https?:\/\//, '').replace(/\/$/, '');

export class StationCard {
  readonly root = el('article', { class: 'station' });
  private readonly picture = el('img', { alt: '' });
  private readonly person = el('span', { class: 'person' });
  private readonly title = el('p', { class: 'title' });
  private readonly clock = el('time');
  private readonly standing = el('p', { class: 'standing', role: 'status' });
  private readonly alarms = el('ul', { class: 'alarms' });
  private readonly open = el('button', { type: 'button' }, text('Open'));
  private shownPicture = 0;

  constructor(
    { name, url }: { name: string; url: string },
    private readonly pictureUrl: (number: number) => string,
    open: () => void,
    remove: (() => void) | null,
  ) {
    this.picture.hidden = true;
    this.open.onclick = open;
    const head = el('header', {}, el('h2', {}, name), this.person, this.clock);
    // Two stations may have one name.
    const place = el('p', { class: 'place' }, placeOf(url));
    this.root.append(el('div', { class: 'frame' }, this.picture), head, place, this.title, this.standing, this.alarms);
    const buttons = el('div', { class: 'buttons' }, this.open);
    if (remove) {
      const take = el('button', { type: 'button' }, text('Remove'));
      take.setAttribute('aria-label', text('Remove {name} from the list', { name }));
      take.onclick = remove;
      buttons.append(take);
    }
    this.root.append(buttons);
  }

  show(s: StationView): void {
    const standing = standingOf(s);
    this.root.dataset.standing = standing;
    if (s.picture !== this.shownPicture) {
      this.shownPicture = s.picture;
      this.picture.hidden = s.picture === 0;
      if (s.picture > 0) this.picture.src = this.pictureUrl(s.picture);
    }
    setText(this.person, s.person === '' ? text('guest') : s.person);
    setText(this.title, said(s.title));
    setText(this.clock, standing === 'away' || standing === 'idle' ? '' : clockText(s.timeS));
    setText(this.standing, standingText(s, standing));
    const lines = alarmLines(s.alarms);
    if (this.alarms.dataset.lines === lines.join('\n')) return;
    this.alarms.dataset.lines = lines.join('\n');
    this.alarms.replaceChildren(...lines.map((l) => el('li', {}, l)));
  }
}
