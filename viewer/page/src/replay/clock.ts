// SPDX-License-Identifier: GPL-3.0-or-later
// The time of a replay: it runs, stands or is moved, always within the recording.

export const speeds = [0.1, 0.25, 0.5, 1, 2, 4, 8] as const;

/** A part of the recording; null: not chosen. */
export interface Stretch {
  fromS: number;
  toS: number;
}

export class ReplayClock {
  timeS = 0;
  playing = false;
  speed = 1;
  stretch: Stretch | null = null;

  constructor(readonly durationS: number) {}

  seek(timeS: number): void {
    this.timeS = Math.min(this.durationS, Math.max(0, timeS));
  }

  /** From the end it starts again. */
  toggle(): void {
    if (!this.playing && this.timeS >= this.durationS) this.timeS = 0;
    this.playing = !this.playing;
  }

  /** One step of `speeds` up or down. */
  changeSpeed(by: 1 | -1): void {
    const at = speeds.findIndex((s) => s >= this.speed);
    this.speed = speeds[Math.min(speeds.length - 1, Math.max(0, at + by))]!;
  }

  /** dtS: of the wall clock. Stands at the end. */
  advance(dtS: number): void {
    if (!this.playing) return;
    this.seek(this.timeS + dtS * this.speed);
    if (this.timeS >= this.durationS) this.playing = false;
  }

  /** Begins the chosen stretch here, or ends it here. An end before the beginning takes its place. */
  mark(which: 'from' | 'to'): void {
    const old = this.stretch ?? { fromS: this.timeS, toS: this.durationS };
    const { timeS } = this;
    this.stretch =
      which === 'from'
        ? { fromS: timeS, toS: old.toS > timeS ? old.toS : this.durationS }
        : { fromS: old.fromS < timeS ? old.fromS : 0, toS: timeS };
  }
}
