// SPDX-License-Identifier: GPL-3.0-or-later
// The wrist guide: how far the tool is from its target, where to move it, how to turn it and with which key.
import type { Offset } from '../guide';
import { el, setText } from './dom';
import { fixed } from '../languages/numbers';
import { text } from '../languages/text';

export interface GuideView {
  /** Which target, of how many. */
  at: number;
  of: number;
  /** How many places the example has left over, of which one is the target; 0: it is the example's own. */
  leftOver: number;
  offset: Offset;
  /** It counts as reached within these. */
  nearM: number;
  nearRad: number;
  /** What the hand shall do that is no movement: "take up the applier", "hold button 1"; '': nothing. */
  todo: string;
  /** Another tool comes first: the way is not for the one in the hand. */
  takeUp: boolean;
  /** The example moves the other hand before this one reaches its target. */
  waits: boolean;
}

interface Direction {
  value: number;
  near: number;
  positive: string;
  negative: string;
  shown: (size: number) => string;
}

const mm = (m: number): string => `${fixed(1000 * m, 1)} mm`;
const degrees = (rad: number): string => `${Math.round((rad * 180) / Math.PI)}°`;

/** What is still to be done, the largest first; nothing that is near enough. */
export function directions(o: Offset, nearM: number, nearRad: number): string[] {
  const parts: Direction[] = [
    { value: o.out, near: nearM / 2, positive: text('⊙ back (S)'), negative: text('⊗ deeper (W)'), shown: mm },
    { value: o.right, near: nearM / 2, positive: text('→ right'), negative: text('← left'), shown: mm },
    { value: o.up, near: nearM / 2, positive: text('↑ up'), negative: text('↓ down'), shown: mm },
    { value: o.roll, near: nearRad / 2, positive: text('↻ roll (E)'), negative: text('↺ roll (Q)'), shown: degrees },
    { value: o.turn, near: nearRad / 2, positive: text('⤴ swing (D)'), negative: text('⤵ swing (A)'), shown: degrees },
    { value: o.tilt, near: nearRad / 2, positive: text('⤒ tilt (F)'), negative: text('⤓ tilt (R)'), shown: degrees },
  ];
  return parts
    .filter((d) => Math.abs(d.value) > d.near)
    .sort((a, b) => Math.abs(b.value) / b.near - Math.abs(a.value) / a.near)
    .map((d) => `${d.value > 0 ? d.positive : d.negative} ${d.shown(Math.abs(d.value))}`);
}

export class GuidePanel {
  readonly root = el('section', { class: 'panel guide', 'aria-label': text('target') });
  private readonly title = el('b');
  private readonly waits = el('p', { class: 'waits' }, text('First the other hand: hold this one here (X)'));
  private readonly todo = el('p', { class: 'todo' });
  private readonly list = el('ul');
  private readonly assist = el(
    'button',
    { title: text('turn the tool slowly as the ghost is turned; its tip stays (Y)'), 'aria-pressed': 'false' },
    text('Turn for me'),
  );
  private shown = '';

  constructor(step: (by: 1 | -1) => void, turn: () => void) {
    const back = el('button', { title: text('previous target (Shift + N)') }, '◀');
    const next = el('button', { title: text('next target (N)') }, '▶');
    back.onclick = () => step(-1);
    next.onclick = () => step(1);
    this.assist.onclick = () => turn();
    this.root.append(
      el('header', {}, this.title, el('span', {}, back, next)),
      this.list,
      this.waits,
      el('div', { class: 'guide-foot' }, this.todo, this.assist),
    );
    this.root.hidden = true;
  }

  /** null: there is no target. assists: the tool is being turned to it. */
  show(view: GuideView | null, assists: boolean): void {
    this.root.hidden = view === null;
    this.assist.setAttribute('aria-pressed', String(assists));
    if (!view) return;
    const { offset, nearM, nearRad, at, of, todo, leftOver } = view;
    this.waits.hidden = !view.waits;
    const near = offset.distanceM < nearM && offset.angleRad < nearRad;
    const what =
      leftOver > 0 ? text('{leftOver} left over', { leftOver }) : text('Target {at} of {of}', { at: at + 1, of });
    setText(this.title, `${what}: ${mm(offset.distanceM)}, ${degrees(offset.angleRad)}`);
    setText(this.todo, todo || (near ? text('✓ there') : ''));
    this.root.dataset.near = String(near);
    const lines = view.takeUp ? [] : directions(offset, nearM, nearRad).slice(0, 4);
    const key = lines.join('\n');
    if (key === this.shown) return;
    this.shown = key;
    this.list.replaceChildren(...lines.map((l) => el('li', {}, l)));
  }
}
