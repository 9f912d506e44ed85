// SPDX-License-Identifier: GPL-3.0-or-later
// Hears the beats of a heart in its phase, and the mean pressure of the beat before each.

/** A phase that falls by more than this has begun anew. */
const fall = 0.5;

export interface Beat {
  /** Mean of the beat before, Pa; null: not known. */
  pressurePa: number | null;
}

export class Beats {
  private phase: number | null = null;
  private sum = 0;
  private count = 0;

  /** phase: 0 to 1, 0 the start of systole; null: not known. The beat that begins with this frame, or null. */
  read(phase: number | null, pressurePa: number | null): Beat | null {
    const begins = phase !== null && this.phase !== null && phase < this.phase - fall;
    const beat = begins ? { pressurePa: this.count > 0 ? this.sum / this.count : null } : null;
    if (begins) this.sum = this.count = 0;
    if (pressurePa !== null) {
      this.sum += pressurePa;
      this.count++;
    }
    this.phase = phase;
    return beat;
  }
}
