// SPDX-License-Identifier: GPL-3.0-or-later
// Devices as they are now, for a live check: words, bars from -1 to 1 that follow a movement, and lamps for buttons.
import type { Pad } from '../gamepad_hands';
import { text } from '../languages/text';
import type { HandState } from '../lcm';

export interface Live {
  says: string;
  bars: number[];
  lamps: boolean[];
}

/** Displacement of a hand that fills a bar, m. */
const fullM = 0.02;

const within = (x: number): number => (Number.isFinite(x) ? Math.max(-1, Math.min(1, x)) : 0);

/** Kind of a device by its name in the haptic server (haptic_server/devices/device_kinds.cpp). */
export function deviceText(name: string): string {
  switch (name) {
    case 'simulated':
      return text('simulated arm');
    case 'mouse':
      return text('simulated arm, moved with the mouse');
    case 'touch':
      return text('Touch or Phantom arm');
    case 'forcedimension':
      return text('Force Dimension arm');
    case 'haply':
      return text('Haply Inverse3 arm');
    case 'spacemouse':
      return text('3D mouse, without forces');
    case 'gamepad':
      return text('gamepad at the haptic server, without forces');
    default:
      return name;
  }
}

/** from: where the hand was when the check began, m; a bar for each axis of the scene. */
export function handLive(hand: HandState, from: ArrayLike<number>): Live {
  const bars = [0, 1, 2].map((k) => within((hand.p_m[k]! - from[k]!) / fullM));
  const kind = deviceText(hand.device);
  const says = hand.connected ? kind : text('{device}: not connected', { device: kind });
  return { says, bars, lamps: [hand.button1, hand.button2] };
}

/** Only pads of the standard mapping move hands. A bar for each axis of its two sticks. */
export function padLive(pad: Pad & { id: string }): Live {
  const name = pad.id.replace(/\s+/g, ' ').slice(0, 60);
  const says = pad.mapping === 'standard' ? name : text('{device}: its buttons are not known', { device: name });
  return { says, bars: [0, 1, 2, 3].map((k) => within(pad.axes[k] ?? 0)), lamps: pad.buttons.map((b) => b.pressed) };
}

export type PointerKind = 'mouse' | 'pen' | 'touch';
export const pointerKinds: readonly PointerKind[] = ['mouse', 'pen', 'touch'];

/** What the browser tells before a pointer was used. */
export interface Reported {
  fine: boolean;
  touchPoints: number;
}

function unusedText(kind: PointerKind, { fine, touchPoints }: Reported): string {
  switch (kind) {
    case 'mouse':
      return fine ? text('there; move it') : text('the browser sees none');
    case 'pen':
      return text('seen once it touches the page');
    case 'touch':
      return touchPoints > 0 ? text('there; touch the page') : text('the browser sees none');
  }
}

interface Used {
  pointerType: string;
  clientX: number;
  clientY: number;
  buttons: number;
  pressure: number;
}

/** Which pointers were used, and how. Bars: across and down in the window; of a pen, its pressure too. */
export class PointerWatch {
  private readonly last = new Map<string, Used>();

  take(e: Used): void {
    this.last.set(e.pointerType, e);
  }

  live(kind: PointerKind, width: number, height: number, reported: Reported): Live {
    const e = this.last.get(kind);
    const none = { clientX: width / 2, clientY: height / 2, buttons: 0, pressure: 0 };
    const { clientX, clientY, buttons, pressure } = e ?? none;
    const bars = [within((2 * clientX) / width - 1), within((2 * clientY) / height - 1)];
    if (kind === 'pen') bars.push(within(pressure));
    const says = e ? text('works') : unusedText(kind, reported);
    return { says, bars, lamps: kind === 'mouse' ? [1, 4, 2].map((b) => (buttons & b) !== 0) : [buttons !== 0] };
  }
}

/** The key that was pressed last, and whether one is held. */
export class KeyWatch {
  private readonly held = new Set<string>();
  private last = '';

  down(e: { code: string; key: string }): void {
    this.held.add(e.code);
    this.last = e.key === ' ' ? text('space bar') : e.key;
  }

  up(e: { code: string }): void {
    this.held.delete(e.code);
  }

  /** The window has lost the focus, so nobody tells when a key comes up. */
  leave(): void {
    this.held.clear();
  }

  live(): Live {
    const says = this.last === '' ? text('press a key') : text('works: {key}', { key: this.last });
    return { says, bars: [], lamps: [this.held.size > 0] };
  }
}
