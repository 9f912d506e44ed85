// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of a scene that was saved while an older state of it runs: they stay over the picture until the file is right.
import { el } from './dom';

export interface NoticeLine { place: string; kind: string; text: string }

/** "a.xml:4:38: error: text" in its three parts; any other line is text alone. */
export function notice_lines(message: string): NoticeLine[] {
  return message.split('\n').filter((l) => l.trim() !== '').map((l) => {
    const m = /^(.+?): (error|warning): (.*)$/.exec(l);
    return m ? { place: m[1]!, kind: m[2]!, text: m[3]! } : { place: '', kind: '', text: l };
  });
}

export class NoticePanel {
  readonly root = el('section', { class: 'notice', role: 'alert' });
  private shown = '';

  constructor() { this.root.hidden = true; }

  show(message: string): void {
    if (message === this.shown) return;
    this.shown = message;
    const lines = notice_lines(message);
    this.root.hidden = lines.length === 0;
    this.root.replaceChildren(el('header', {}, 'The saved scene has errors. What runs is the scene before.'),
      ...lines.map((l) => el('div', { 'data-kind': l.kind }, ...(l.place ? [el('code', {}, l.place), ' '] : []), ...(l.kind ? [el('b', {}, `${l.kind}:`), ' '] : []), l.text)));
  }
}
