// SPDX-License-Identifier: GPL-3.0-or-later
// A click of the wheel is a click in each browser.
import { describe, expect, it } from 'vitest';
import { wheelClicks, wheelZoom } from '../src/wheel';

const pixels = (deltaY: number, deltaX = 0) => ({ deltaX, deltaY, deltaMode: 0 });

/** Firefox gives lines if its unit was looked at first, and else pixels. */
class FirefoxWheel {
  readonly deltaX = 0;
  private unit = 0;
  private seen = false;
  constructor(private readonly lines: number) {}

  get deltaMode(): number {
    if (!this.seen) this.unit = 1;
    this.seen = true;
    return this.unit;
  }
  get deltaY(): number {
    this.seen = true;
    return this.unit === 1 ? this.lines : 16 * this.lines;
  }
}

describe('wheel', () => {
  it('has the same click in Chromium and Firefox', () => {
    expect(wheelClicks(pixels(100))).toBe(1);
    expect(wheelClicks(new FirefoxWheel(3))).toBe(1);
    expect(wheelClicks(new FirefoxWheel(-3))).toBe(-1);
    expect(wheelZoom(new FirefoxWheel(3))).toBe(wheelZoom(pixels(100)));
  });

  it('reads the way sideways, which some browsers give with Shift', () => {
    expect(wheelClicks(pixels(0, -200))).toBe(-2);
  });

  it('does not jump on a long swipe, nor on a wheel that counts pages', () => {
    expect(wheelClicks(pixels(5000))).toBe(3);
    expect(wheelClicks({ deltaX: 0, deltaY: -1, deltaMode: 2 })).toBe(-1);
  });
});
