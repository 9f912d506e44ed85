// SPDX-License-Identifier: GPL-3.0-or-later
// What two fingers mean. The first clear movement decides, and it stays so until a finger is lifted: apart or together
// zooms, turning about each other rolls the tool, sliding up or down pushes it deeper or draws it back, sliding
// sideways swings it.

export type GestureKind = 'zoom' | 'roll' | 'depth' | 'swing';

export interface GestureStep {
  kind: GestureKind;
  /** zoom: factor of the distance of the fingers; roll: radians, clockwise; depth, swing: pixels down, to the right. */
  by: number;
}

interface Point {
  x: number;
  y: number;
}

interface Pair {
  distance: number;
  angle: number;
  x: number;
  y: number;
}

const zoomPx = 18;
const rollRad = 0.16;
const slidePx = 14;

const pairOf = (a: Point, b: Point): Pair => ({
  distance: Math.hypot(b.x - a.x, b.y - a.y),
  angle: Math.atan2(b.y - a.y, b.x - a.x),
  x: (a.x + b.x) / 2,
  y: (a.y + b.y) / 2,
});

/** Between -pi and pi. */
const wrapped = (angle: number): number => Math.atan2(Math.sin(angle), Math.cos(angle));

export class TwoFingers {
  private first: Pair | null = null;
  private last: Pair | null = null;
  private kind: GestureKind | null = null;

  /** A finger came or went. */
  clear(): void {
    this.first = this.last = this.kind = null;
  }

  /** Where the two fingers are now; null while it is not clear what is meant. */
  move(a: Point, b: Point): GestureStep | null {
    const now = pairOf(a, b);
    if (!this.first || !this.last) {
      this.first = this.last = now;
      return null;
    }
    this.kind ??= chosen(this.first, now);
    if (!this.kind) return null;
    const last = this.last;
    this.last = now;
    switch (this.kind) {
      case 'zoom':
        return { kind: 'zoom', by: now.distance / Math.max(1, last.distance) };
      case 'roll':
        return { kind: 'roll', by: wrapped(now.angle - last.angle) };
      case 'depth':
        return { kind: 'depth', by: now.y - last.y };
      case 'swing':
        return { kind: 'swing', by: now.x - last.x };
    }
  }
}

/** The movement that is farthest beyond its own threshold. */
function chosen(first: Pair, now: Pair): GestureKind | null {
  const dx = Math.abs(now.x - first.x);
  const dy = Math.abs(now.y - first.y);
  const shares: [GestureKind, number][] = [
    ['zoom', Math.abs(now.distance - first.distance) / zoomPx],
    ['roll', Math.abs(wrapped(now.angle - first.angle)) / rollRad],
    ['depth', dy >= dx ? dy / slidePx : 0],
    ['swing', dx > dy ? dx / slidePx : 0],
  ];
  shares.sort((a, b) => b[1] - a[1]);
  const [kind, share] = shares[0]!;
  return share >= 1 ? kind : null;
}
