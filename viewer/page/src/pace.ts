// SPDX-License-Identifier: GPL-3.0-or-later
// How fast pictures come: the time of each, and once a second their rate.

export class Pace {
  private last = performance.now();
  private from = performance.now();
  private counted = 0;

  /** told: once a second, with the pictures per second and the seconds that they were counted over. */
  constructor(private readonly told: (fps: number, seconds: number) => void) {}

  /** At the beginning of a picture; milliseconds since the last one began. */
  begin(now: number): number {
    const ms = Math.max(0, now - this.last);
    this.last = now;
    return ms;
  }

  /** Time without pictures is not counted. */
  rest(now: number): void {
    this.last = this.from = now;
    this.counted = 0;
  }

  /** drawn: somebody could see it. */
  count(now: number, drawn: boolean): void {
    if (drawn) this.counted++;
    const seconds = (now - this.from) / 1000;
    if (seconds <= 1) return;
    const fps = this.counted / seconds;
    this.counted = 0;
    this.from = now;
    this.told(fps, seconds);
  }
}
