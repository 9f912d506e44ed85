// SPDX-License-Identifier: GPL-3.0-or-later
// For the instructor: what is near a hint now, the worst first, with its share of the way to the limit.
import { text } from '../languages/text';
import { whyText } from '../tutor/cue_line';
import type { HintView } from '../tutor/state';
import { el, setText } from './dom';

interface Row {
  row: HTMLElement;
  words: HTMLElement;
  share: HTMLElement;
  why: HTMLElement;
  bar: HTMLElement;
}

export class CausesPanel {
  readonly root = el('div', { class: 'causes' });
  private readonly none = el('p', { class: 'quiet' }, text('Nothing is near its limit.'));
  private readonly list = el('ol');
  private readonly rows: Row[] = [];

  constructor() {
    this.root.append(this.none, this.list);
  }

  show(causes: readonly HintView[]): void {
    this.none.hidden = causes.length > 0;
    while (this.rows.length < causes.length) this.rows.push(this.add());
    this.rows.forEach((r, k) => {
      const c = causes[k];
      r.row.hidden = c === undefined;
      if (!c) return;
      r.row.dataset.holds = String(c.holds);
      setText(r.words, c.text);
      setText(r.share, `${Math.round(100 * c.share)} %`);
      setText(r.why, whyText(c));
      r.bar.style.width = `${Math.min(100, Math.max(0, 100 * c.share))}%`;
    });
  }

  private add(): Row {
    const [words, share, why, bar] = [el('span'), el('b'), el('small'), el('i')];
    const row = el('li', {}, words, share, el('div', { class: 'bar' }, bar), why);
    this.list.append(row);
    return { row, words, share, why, bar };
  }
}
