// SPDX-License-Identifier: GPL-3.0-or-later
// Stations that announce themselves in the network and are not listed. Nothing is known of them but what they say, so
// they are opened in a window of their own, where the station asks for a login.
import { el } from '../hud/dom';
import { text } from '../languages/text';
import type { FoundStation, RoomView } from './overview';

export class FoundStations {
  readonly root = el('section', { class: 'found' });
  private shown = '';

  /** add: lists one. */
  constructor(private readonly add: (station: FoundStation) => void) {}

  show({ found, searchError }: RoomView): void {
    const now = JSON.stringify([found, searchError]);
    if (now === this.shown) return;
    this.shown = now;
    this.root.replaceChildren(el('h2', {}, text('Found in the network')), ...this.content(found, searchError));
  }

  private content(found: FoundStation[], searchError: string): HTMLElement[] {
    if (searchError !== '')
      return [el('p', {}, text('Stations are not looked for in the network: {why}.', { why: searchError }))];
    if (found.length === 0) return [el('p', {}, text('No other stations announce themselves.'))];
    return [el('ul', {}, ...found.map((f) => this.line(f)))];
  }

  private line(station: FoundStation): HTMLElement {
    const open = el('a', { href: `${station.url}?role=instructor`, target: '_blank', rel: 'noopener noreferrer' });
    open.append(text('Open'));
    const add = el('button', { type: 'button' }, text('Add'));
    add.onclick = () => this.add(station);
    return el('li', {}, el('b', {}, station.name), el('span', {}, station.url), open, add);
  }
}
