// SPDX-License-Identifier: GPL-3.0-or-later
// The way to the overview of the room, for who may see it: an instructor, or somebody at this machine.
import { el } from '../hud/dom';
import { text } from '../languages/text';
import type { Api } from './api';

export function roomLink(api: Api): HTMLElement {
  const link = el('a', { href: 'room.html', class: 'room-link', hidden: '' }, text('The room'));
  const show = async () => {
    const { access } = (await api.ask('login')) as { access?: unknown };
    link.hidden = access !== 'here' && access !== 'instructor';
  };
  void show().catch(() => undefined);
  return link;
}
