// SPDX-License-Identifier: GPL-3.0-or-later
// Errors that stay over the picture until they are mended: of a saved scene, or of the engine's data.
import { el } from './dom';

export interface NoticeLine {
  place: string;
  kind: string;
  text: string;
}

/** "a.xml:4:38: error: text" in its three parts; any other line is text alone. */
export function noticeLines(message: string): NoticeLine[] {
  return message
    .split('\n')
    .filter((l) => l.trim() !== '')
    .map((l) => {
      const m = /^(.+?): (error|warning): (.*)$/.exec(l);
      return m ? { place: m[1]!, kind: m[2]!, text: m[3]! } : { place: '', kind: '', text: l };
    });
}

export class NoticePanel {
  readonly root = el('section', { class: 'notice', role: 'alert' });
  private shown = '';

  constructor(private readonly title: string) {
    this.root.hidden = true;
  }

  show(message: string): void {
    if (message === this.shown) return;
    this.shown = message;
    const lines = noticeLines(message);
    this.root.hidden = lines.length === 0;
    this.root.replaceChildren(
      el('header', {}, this.title),
      ...lines.map((l) =>
        el(
          'div',
          { 'data-kind': l.kind },
          ...(l.place ? [el('code', {}, l.place), ' '] : []),
          ...(l.kind ? [el('b', {}, `${l.kind}:`), ' '] : []),
          l.text,
        ),
      ),
    );
  }
}
