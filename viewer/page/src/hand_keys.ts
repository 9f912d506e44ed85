// SPDX-License-Identifier: GPL-3.0-or-later
// Keys that drive the active hand. A key keeps its meaning until it goes up, whatever else is pressed meanwhile.
import type { HandPose, Button } from './hand_pose';
import type { Hands } from './hands';
import { isControl, isTyping, keyOf } from './keyboard';

export interface KeyActions {
  /** By a letter or digit, when it goes down; shift: with Shift. */
  commands: Record<string, (shift: boolean) => void>;
  /** The user wants to leave the field for the controls. */
  leaveField(): void;
  changed(): void;
}

const mPerS = 0.012;
const radPerS = 0.9;
const arrows = new Set(['arrowleft', 'arrowright', 'arrowup', 'arrowdown']);
const moving = new Set(['w', 's', 'a', 'd', 'q', 'e', 'r', 'f', ...arrows]);
const buttonOf: Record<string, Button> = { space: 1, b: 2 };

export class HandKeys {
  /** What each held key means. */
  private readonly keys = new Map<string, string>();
  /** Held keys that press a button, with the hand they press it for. */
  private readonly pressing = new Map<string, { hand: HandPose; button: Button }>();

  constructor(
    private readonly hands: Hands,
    private readonly actions: KeyActions,
  ) {
    window.addEventListener('keydown', (e) => this.down(e));
    window.addEventListener('keyup', (e) => this.up(e.code));
    window.addEventListener('blur', () => this.letGo());
    hands.leaving.push(() => this.pressing.clear());
    hands.steady.push((dt) => this.apply(dt));
  }

  /** Held keys move the active hand. */
  private apply(dt: number): void {
    const down = new Set(this.keys.values());
    if (![...down].some((k) => moving.has(k))) return;
    const fine = down.has('shift') ? 0.3 : 1;
    const pair = (more: string, less: string) => (down.has(more) ? 1 : 0) - (down.has(less) ? 1 : 0);
    const s = mPerS * fine * dt;
    this.hands.move({
      right: pair('arrowright', 'arrowleft') * s,
      up: pair('arrowup', 'arrowdown') * s,
      out: pair('s', 'w') * s,
    });
    const a = radPerS * fine * dt;
    this.hands.turn({ roll: pair('e', 'q') * a, swing: pair('d', 'a') * a, tilt: pair('f', 'r') * a });
  }

  private down(e: KeyboardEvent): void {
    const key = keyOf(e);
    if (isTyping(e.target) || e.ctrlKey || e.metaKey || e.altKey) return;
    if (isControl(e.target) && (key === 'space' || key === 'enter' || key === 'tab' || arrows.has(key))) return;
    if (moving.has(key) || key === 'shift') {
      this.keys.set(e.code, key);
      if (key !== 'shift') e.preventDefault();
      return;
    }
    const button = buttonOf[key];
    if (button) {
      e.preventDefault();
      if (!e.repeat) this.press(e.code, button);
      return;
    }
    if (e.repeat) return;
    // Shift and Tab, and Escape, lead out of the field to the controls.
    if (key === 'tab' && !e.shiftKey) {
      e.preventDefault();
      this.hands.setActive(1 - this.hands.active);
    } else if (key === 'escape' && !isControl(e.target)) this.actions.leaveField();
    else this.actions.commands[key]?.(e.shiftKey);
  }

  private up(code: string): void {
    this.keys.delete(code);
    const pressed = this.pressing.get(code);
    if (!pressed) return;
    this.pressing.delete(code);
    pressed.hand.hold(pressed.button, false);
    this.actions.changed();
  }

  /** The key of a latched button lets it go. */
  private press(code: string, button: Button): void {
    if (!this.hands.take()) return;
    const hand = this.hands.hands[this.hands.active]!;
    if (hand.latched(button)) hand.latch(button, false);
    else {
      hand.hold(button, true);
      this.pressing.set(code, { hand, button });
    }
    this.actions.changed();
  }

  /** The window has lost the keys. */
  private letGo(): void {
    this.keys.clear();
    this.pressing.clear();
    this.hands.letGoHeld();
  }
}
