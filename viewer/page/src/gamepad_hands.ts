// SPDX-License-Identifier: GPL-3.0-or-later
// A gamepad as two hands: each stick moves its own hand in the picture plane, and with its shoulder button pushes it
// deeper or rolls it. Triggers are the first buttons, pressed sticks the second ones. The cross swings and tilts the
// left hand's tool, the four buttons on the right that of the right hand.
import type { Hands } from './hands';

/** Of the standard mapping (W3C Gamepad). */
const axisOf = [0, 2];
const bumper = [4, 5];
const trigger = [6, 7];
const stick = [10, 11];
/** Up, down, left, right. */
const diamond = [
  [12, 13, 14, 15],
  [3, 0, 2, 1],
];
const otherHand = 8;

const deadZone = 0.15;
const pressed = 0.5;
const mPerS = 0.02;
const depthMPerS = 0.012;
const radPerS = 0.9;

export interface Pad {
  index: number;
  mapping: string;
  axes: readonly number[];
  buttons: readonly { value: number; pressed: boolean }[];
}

export interface PadHand {
  /** Shares of the full speed, -1..1: to the right, up, to the viewer; clockwise; to the right; towards the user. */
  right: number;
  up: number;
  out: number;
  clockwise: number;
  swing: number;
  tilt: number;
  button1: boolean;
  button2: boolean;
}

/** Fine near the middle, nothing at rest. */
export function deflection(value: number): number {
  const v = Number.isFinite(value) ? Math.min(1, Math.abs(value)) : 0;
  return v <= deadZone ? 0 : Math.sign(value) * ((v - deadZone) / (1 - deadZone)) ** 2;
}

/** What a pad asks of the left and of the right hand. */
export function readPad(pad: Pad): [PadHand, PadHand] {
  const value = (b: number) => pad.buttons[b]?.value ?? 0;
  const on = (b: number) => value(b) > pressed || (pad.buttons[b]?.pressed ?? false);
  const one = (hand: number): PadHand => {
    const x = deflection(pad.axes[axisOf[hand]!] ?? 0);
    const y = deflection(pad.axes[axisOf[hand]! + 1] ?? 0);
    const deep = on(bumper[hand]!);
    const [up, down, left, right] = diamond[hand]!.map((b) => (on(b) ? 1 : 0));
    return {
      right: deep ? 0 : x,
      up: deep ? 0 : -y,
      // The stick away from the user pushes the tool away from the user.
      out: deep ? y : 0,
      clockwise: deep ? x : 0,
      swing: right! - left!,
      tilt: down! - up!,
      button1: on(trigger[hand]!),
      button2: on(stick[hand]!),
    };
  };
  return [one(0), one(1)];
}

interface Pressed {
  buttons: [boolean, boolean][];
  other: boolean;
}

export class GamepadHands {
  private readonly before = new Map<number, Pressed>();

  /** pads: those that are plugged in. free: whether hands may be driven now. */
  constructor(
    private readonly hands: Hands,
    private readonly pads: () => readonly (Pad | null)[],
    private readonly free: () => boolean,
  ) {
    hands.steady.push((dt) => this.apply(dt));
  }

  private apply(dt: number): void {
    if (!this.free()) return;
    const found = this.pads().filter((p) => p?.mapping === 'standard') as Pad[];
    for (const [index, was] of this.before) if (!found.some((p) => p.index === index)) this.unplugged(index, was);
    for (const pad of found) this.follow(pad, dt);
  }

  private follow(pad: Pad, dt: number): void {
    const was = this.before.get(pad.index) ?? { buttons: [0, 1].map(() => [false, false]), other: false };
    const now = readPad(pad);
    now.forEach((h, hand) => {
      const [s, d, a] = [mPerS * dt, depthMPerS * dt, radPerS * dt];
      if (h.right !== 0 || h.up !== 0 || h.out !== 0)
        this.hands.move({ right: h.right * s, up: h.up * s, out: h.out * d }, hand);
      this.hands.turn({ swing: h.swing * a, tilt: h.tilt * a }, hand);
      this.hands.rollSeen(h.clockwise * a, hand);
      this.press(hand, 1, h.button1, was.buttons[hand]![0]!);
      this.press(hand, 2, h.button2, was.buttons[hand]![1]!);
    });
    const other = pad.buttons[otherHand]?.pressed ?? false;
    if (other && !was.other) this.hands.setActive(1 - this.hands.active);
    this.before.set(pad.index, { buttons: now.map((h) => [h.button1, h.button2]), other });
  }

  /** The button of a latched one lets it go, as its key does. */
  private press(hand: number, button: 1 | 2, on: boolean, was: boolean): void {
    if (on === was) return;
    if (on && this.hands.hands[hand]!.latched(button)) this.hands.toggleLatch(hand, button);
    else this.hands.press(button, on, hand);
  }

  private unplugged(index: number, was: Pressed): void {
    this.before.delete(index);
    was.buttons.forEach((held, hand) => held.forEach((on, k) => on && this.hands.press(k === 0 ? 1 : 2, false, hand)));
  }
}
