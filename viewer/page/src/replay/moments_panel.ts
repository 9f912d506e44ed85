// SPDX-License-Identifier: GPL-3.0-or-later
// What happened, in order, with the notes of those who watched. A click goes there.
import { el } from '../hud/dom';
import { clockText } from '../hud/state';
import type { Mark } from './chart';
import { text } from '../languages/text';

const signs: Record<string, string> = { fault: '✗', goal: '✓', note: '✎' };

export class MomentsPanel {
  readonly root = el('section', { class: 'panel moments' });
  private readonly list = el('ol');
  private items: { mark: Mark; item: HTMLElement }[] = [];

  constructor(
    private readonly go: (timeS: number) => void,
    private readonly remove: (mark: Mark) => void,
  ) {
    this.root.append(el('h2', {}, text('Moments')), this.list);
  }

  show(marks: readonly Mark[]): void {
    this.items = marks.map((mark) => ({ mark, item: this.makeItem(mark) }));
    this.list.replaceChildren(...this.items.map((i) => i.item));
  }

  /** The last one before the present time stands out. */
  at(timeS: number): void {
    const last = this.items.findLastIndex((i) => i.mark.timeS <= timeS + 0.05);
    this.items.forEach(({ item }, k) => {
      if (item.classList.contains('now') === (k === last)) return;
      item.classList.toggle('now', k === last);
      if (k === last) item.scrollIntoView({ block: 'nearest' });
    });
  }

  private makeItem(mark: Mark): HTMLElement {
    const go = el('button', { 'data-kind': mark.kind }, el('b', {}, clockText(mark.timeS)));
    go.append(` ${signs[mark.kind] ?? ''} ${mark.text}`);
    go.onclick = () => this.go(mark.timeS);
    const item = el('li', {}, go);
    if (mark.kind === 'note') {
      const away = el(
        'button',
        { class: 'remove', title: text('remove this note'), 'aria-label': text('remove this note') },
        '×',
      );
      away.onclick = () => this.remove(mark);
      item.append(away);
    }
    return item;
  }
}
