// SPDX-License-Identifier: GPL-3.0-or-later
// One hand: its force, whether the mouse drives it, and its tools.
import { el, setText } from './dom';
import { forceBar, forceLevel } from './state';
import { Tray } from './tray';
import type { UserCommand } from './commands';

export interface HandActions {
  run(command: UserCommand): void;
  chooseHand(hand: number): void;
  releaseHand(hand: number): void;
}

export interface HandView {
  /** N; null: the hand has no tool. */
  force: number | null;
  kind: string;
  active: boolean;
  taken: boolean;
}

export class HandPanel {
  readonly root = el('div', { class: 'hand' });
  readonly tray: Tray;
  private readonly name = el('span', { class: 'name' });
  private readonly tag = el('span', { class: 'tag' });
  private readonly number = el('span', { class: 'force' }, '–');
  private readonly fill = el('i');

  constructor(hand: number, actions: HandActions, mayDrive: boolean) {
    this.tray = new Tray((c) => actions.run(c), mayDrive);
    setText(this.name, hand === 0 ? 'Left' : 'Right');
    const head = el('button', { class: 'choose', title: 'drive this hand' }, this.name, this.tag);
    head.onclick = () => actions.chooseHand(hand);
    this.tag.onclick = (e) => {
      if (!this.root.classList.contains('taken')) return;
      e.stopPropagation();
      actions.releaseHand(hand);
    };
    this.root.append(head, el('div', { class: 'bar' }, this.fill), this.number, this.tray.root);
  }

  show({ force, kind, active, taken }: HandView): void {
    this.root.classList.toggle('active', active);
    this.root.classList.toggle('taken', taken);
    setText(this.tag, taken ? 'mouse ✕' : kind);
    setText(this.number, force === null ? '–' : `${force.toFixed(2)} N`);
    this.fill.style.width = `${force === null ? 0 : forceBar(force) * 100}%`;
    this.root.dataset.level = force === null ? 'good' : forceLevel(force);
  }
}
