// SPDX-License-Identifier: GPL-3.0-or-later
// At most so many sounds of a kind in a stretch of time: thirty strands that part at once are heard as a few.

export class RateLimit {
  private readonly begun: number[] = [];

  constructor(
    private readonly most: number,
    private readonly withinS: number,
  ) {}

  /** Whether one more may begin now, s. Counts it. */
  allows(nowS: number): boolean {
    while (this.begun.length > 0 && !(nowS - this.begun[0]! < this.withinS && nowS >= this.begun[0]!))
      this.begun.shift();
    if (this.begun.length >= this.most) return false;
    this.begun.push(nowS);
    return true;
  }
}
