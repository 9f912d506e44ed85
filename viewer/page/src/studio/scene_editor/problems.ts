// SPDX-License-Identifier: GPL-3.0-or-later
// The list of what `insula check` finds, and what is proposed in place of a wrong name.
import { el } from '../../hud/dom';
import { text } from '../../languages/text';
import type { Problem } from './api';
import type { Change } from './edits';

/** How far behind its place a wrong name may stand. */
const reach = 400;

/** The wrong name of a message and the proposed one, as a change of the text; null: none is proposed. */
export function meant(doc: string, from: number, { text: words, nearest }: Problem): Change | null {
  if (nearest === '') return null;
  const before = words.slice(0, words.lastIndexOf('did you mean'));
  const wrong = [...before.matchAll(/"([^"]+)"|<([^>]+)>/g)].map((m) => m[1] ?? m[2] ?? '').at(-1) ?? '';
  const at = wrong === '' ? -1 : doc.slice(from, from + reach).indexOf(wrong);
  return at < 0 ? null : { from: from + at, to: from + at + wrong.length, insert: nearest };
}

export class ProblemList {
  readonly root: HTMLElement;
  private readonly head = el('h3', {});
  private readonly rows = el('ol', { class: 'found' });

  constructor(private readonly go: (p: Problem) => void) {
    this.root = el('section', { class: 'problem-list', 'aria-label': text('Problems') }, this.head, this.rows);
    this.show([]);
  }

  show(problems: readonly Problem[]): void {
    this.head.textContent = text('{count, plural, =0 {No problems} one {# problem} other {# problems}}', {
      count: problems.length,
    });
    this.rows.replaceChildren(...problems.map((p) => this.row(p)));
  }

  private row(p: Problem): HTMLElement {
    const where = p.line > 0 ? `${p.file.split('/').at(-1)}:${p.line}` : p.file.split('/').at(-1)!;
    const button = el(
      'button',
      { type: 'button', class: p.severity, title: p.file },
      el('span', { class: 'where' }, where),
      ' ',
      el('span', {}, p.text),
    );
    button.onclick = () => this.go(p);
    return el('li', {}, button);
  }
}
