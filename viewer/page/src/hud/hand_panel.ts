// SPDX-License-Identifier: GPL-3.0-or-later
// One hand: its force with a word for how much that is, whether the mouse drives it, its buttons, and its tools.
import type { HandData } from '../bundle_types';
import { el, setText } from './dom';
import { distanceText } from '../depth_cue';
import type { Button } from '../hand_pose';
import type { HandState } from '../hands';
import { forceBar, forceLevel } from './state';
import { Tray } from './tray';
import type { UserCommand } from './commands';
import { fixed } from '../languages/numbers';
import { said } from '../languages/said';
import { text } from '../languages/text';

export interface HandActions {
  run(command: UserCommand): void;
  chooseHand(hand: number): void;
  releaseHand(hand: number): void;
  toggleLatch(hand: number, button: Button): void;
  holdHere(hand: number): void;
}

/** Of the tips in the field, mm; null: not shown, or too far. */
export interface DepthView {
  tip_mm: (number | null)[];
  ruler_mm: number | null;
  apart_mm: number | null;
}

/** "tip 3.5 mm · tips 5.2 mm apart"; what belongs to the ruler stands at the active hand. */
export function depthText(
  { tip_mm: tips, ruler_mm: ruler, apart_mm: apart }: DepthView,
  hand: number,
  active: number,
): string {
  const tip = tips[hand] ?? null;
  return [
    tip === null ? '' : text('tip {distance}', { distance: distanceText(tip / 1000) }),
    hand !== active || ruler === null ? '' : text('ruler {distance}', { distance: `${fixed(ruler, 1)} mm` }),
    hand !== active || apart === null ? '' : text('tips {distance} apart', { distance: `${fixed(apart, 1)} mm` }),
  ]
    .filter((t) => t !== '')
    .join(' · ');
}

export interface HandView extends HandState {
  /** N; null: the hand has no tool. */
  force: number | null;
  kind: string;
  /** How far its tip is from what; '': nothing is known. */
  depth: string;
  /** What its tool could take back; '': nothing. */
  reach: string;
  active: boolean;
}

/** Not by colour alone. */
const levelWords = { good: text('gentle'), high: text('high'), too_much: text('too much') };

export class HandPanel {
  readonly root = el('div', { class: 'hand' });
  readonly tray: Tray;
  private readonly name = el('span', { class: 'name' });
  private readonly tag = el('span', { class: 'tag' });
  private readonly number = el('span', { class: 'force' }, '–');
  private readonly level = el('span', { class: 'level' });
  private readonly fill = el('i');
  private readonly giveBack = el(
    'button',
    { class: 'give-back', title: text('give the hand back (G)') },
    text('Give back'),
  );
  private readonly hold = el('button', { class: 'hold', 'aria-pressed': 'false' });
  private readonly undo = el('button', { class: 'undo' }, '↶');
  private readonly depth = el('div', { class: 'depth' });
  private readonly reach = el('div', { class: 'depth reach' });
  private resting = false;
  private readonly latches: HTMLButtonElement[];

  constructor(hand: number, actions: HandActions, mayDrive: boolean) {
    this.tray = new Tray((c) => actions.run(c), mayDrive);
    setText(this.name, hand === 0 ? text('Left') : text('Right'));
    const head = el('button', { class: 'choose', title: text('drive this hand') }, this.name, this.tag);
    head.onclick = () => actions.chooseHand(hand);
    this.giveBack.onclick = () => actions.releaseHand(hand);
    this.hold.onclick = () => {
      if (this.resting) actions.chooseHand(hand);
      else actions.holdHere(hand);
    };
    this.undo.onclick = () => this.tray.undo();
    this.latches = ([1, 2] as const).map((b) => {
      const button = el('button', { class: 'latch', 'aria-pressed': 'false', 'data-latch': String(b) });
      button.onclick = () => actions.toggleLatch(hand, b);
      return button;
    });
    const held = el('div', { class: 'held' }, ...this.latches, this.hold, this.undo, this.giveBack);
    held.hidden = !mayDrive;
    const force = el('span', { class: 'force-text' }, this.level, this.number);
    this.root.append(head, el('div', { class: 'bar' }, this.fill), force, held, this.depth, this.reach, this.tray.root);
  }

  /** The tools of another scene. Until its first frame nothing is known of the hand. */
  showScene(hand: HandData | null): void {
    const off = { on: false, latched: false };
    this.tray.showScene(hand);
    const free = { active: this.root.classList.contains('active'), taken: false, resting: false, buttons: [off, off] };
    this.show({ force: null, kind: '', depth: '', reach: '', ...free });
  }

  show({ force, kind, depth, reach, active, taken, resting, buttons }: HandView): void {
    this.root.classList.toggle('active', active);
    this.root.classList.toggle('taken', taken);
    setText(this.tag, taken ? text('{tool}, yours', { tool: kind }) : kind);
    this.giveBack.hidden = !taken;
    this.showHold(resting);
    setText(this.depth, depth);
    setText(this.reach, reach);
    this.reach.hidden = reach === '';
    this.latches.forEach((latch, k) => {
      const b = buttons[k] ?? { on: false, latched: false };
      latch.setAttribute('aria-pressed', String(b.on));
      const button = k + 1;
      latch.title = b.on
        ? text('let button {button} go', { button })
        : text('hold button {button} until it is let go', { button });
      setText(latch, b.latched ? text('🔒 {button} held', { button }) : `${b.on ? '●' : '○'} ${button}`);
    });
    setText(this.number, force === null ? '–' : `${fixed(force, 2)} N`);
    this.fill.style.width = `${force === null ? 0 : forceBar(force) * 100}%`;
    const level = force === null ? 'good' : forceLevel(force);
    this.root.dataset.level = level;
    setText(this.level, force === null || force < 0.005 ? '' : levelWords[level]);
  }

  private showHold(resting: boolean): void {
    this.resting = resting;
    this.hold.setAttribute('aria-pressed', String(resting));
    this.hold.title = resting ? text('go on with this hand') : text('hold this hand here and take the other one (X)');
    setText(this.hold, resting ? text('📌 holds') : text('Hold'));
    const undone = this.tray.undone;
    this.undo.hidden = undone === null;
    this.undo.title = undone ? text('back to: {tool} (Z)', { tool: said(undone.title) }) : '';
  }
}
