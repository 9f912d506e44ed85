// SPDX-License-Identifier: GPL-3.0-or-later
// The words of a cue over the field, with the value that came near its limit.
import { el, setText } from '../hud/dom';
import { said } from '../languages/said';
import { text } from '../languages/text';
import type { HintView } from './state';

/** The words of what is watched: "brain_force.left.force" is "brain force, left, force". */
const watchedText = (id: string): string =>
  id
    .replace(/ (left|right)$/, '.$1') // of a metric: its hand
    .split('.')
    .map((name) => said(name.replace(/_/g, ' ')))
    .join(', ');

/** "brain force, left, force: 160 mN, limit 200 mN" */
export const whyText = (h: Pick<HintView, 'watched' | 'value' | 'limit'>): string =>
  text('{watched}: {value}, limit {limit}', { watched: watchedText(h.watched), value: h.value, limit: h.limit });

export class CueLine {
  readonly root = el('div', { class: 'cue', role: 'status', 'aria-live': 'assertive' });
  private readonly who = el('b');
  private readonly words = el('span');
  private readonly why = el('small');
  private readonly force = el('small', { class: 'force' });

  constructor() {
    this.root.append(this.who, this.words, this.why, this.force);
    this.root.hidden = true;
  }

  /** null: nothing is said. guided: the hand that a soft force draws, -1: none. */
  show(cue: HintView | null, guided = -1): void {
    this.root.hidden = cue === null;
    if (!cue) return;
    const hands = [text('Left hand'), text('Right hand')];
    setText(this.who, hands[cue.hand] ?? text('Hint'));
    setText(this.words, cue.text);
    setText(this.why, whyText(cue));
    this.force.hidden = guided < 0;
    setText(this.force, guided < 0 ? '' : text('A soft force draws the hand away'));
    this.root.dataset.hint = cue.id;
  }
}
