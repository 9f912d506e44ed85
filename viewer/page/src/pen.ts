// SPDX-License-Identifier: GPL-3.0-or-later
// A pen as a wrist: the tool leans as the pen leans and rolls as it is twisted. A finger beside the pen pushes the tool
// deeper or rolls it, for pens that do not know their twist.
import type { Turn } from './hands';

/** A hand that moves a pen leans it a little without meaning to. */
const slackRad = (3 * Math.PI) / 180;
const decidesPx = 10;

type PenLean = Pick<PointerEvent, 'tiltX' | 'tiltY' | 'twist'>;

const radians = (degrees: number): number => (degrees * Math.PI) / 180;
const wrapped = (angle: number): number => Math.atan2(Math.sin(angle), Math.cos(angle));

/** Follows an angle with some slack: what it turns by when it is dragged along. */
class Slack {
  private anchor: number | null = null;

  follow(angle: number): number {
    this.anchor ??= angle;
    const off = wrapped(angle - this.anchor);
    const by = Math.sign(off) * Math.max(0, Math.abs(off) - slackRad);
    this.anchor += by;
    return by;
  }
}

export class PenWrist {
  private readonly across = new Slack();
  private readonly along = new Slack();
  private readonly about = new Slack();

  /** clockwise: seen in the picture, rad. */
  move(pen: PenLean): Turn & { clockwise: number } {
    return {
      swing: this.across.follow(radians(pen.tiltX)),
      tilt: this.along.follow(radians(pen.tiltY)),
      clockwise: this.about.follow(radians(pen.twist)),
    };
  }
}

/** A finger beside the pen; its first clear movement decides, until it is lifted. */
export class FingerBesidePen {
  private dx = 0;
  private dy = 0;
  private kind: 'depth' | 'roll' | null = null;

  /** Pixels that the finger went since the last time: down, for depth, or to the right, for roll. */
  move(dx: number, dy: number): { kind: 'depth' | 'roll'; by: number } | null {
    if (this.kind === null) {
      this.dx += dx;
      this.dy += dy;
      if (Math.max(Math.abs(this.dx), Math.abs(this.dy)) < decidesPx) return null;
      this.kind = Math.abs(this.dy) >= Math.abs(this.dx) ? 'depth' : 'roll';
    }
    return { kind: this.kind, by: this.kind === 'depth' ? dy : dx };
  }
}
