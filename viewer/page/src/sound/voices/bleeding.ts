// SPDX-License-Identifier: GPL-3.0-or-later
// Blood or another fluid comes into the field. A slow bleeding is heard as drops. Above some drops a second the ear
// hears no more of them, and a stream of noise about 800 Hz joins in. Its level grows with the square root of the
// rate, as loudness is felt.
import { HeldNoise, type Timbre } from '../held_noise';
import type { Place } from '../mixer';
import { drip } from './drop';

/** Of one drop, m3. */
const dropM3 = 50e-9;
/** More are not told apart, 1/s. */
const mostDrops = 9;
/** Where the stream has its full level, m3/s (60 ml/min). */
const fullRate = 1e-6;
/** Slower than this it is only drops, m3/s (6 ml/min). */
const streamFrom = 1e-7;

/** rate: m3/s. */
export const dropsPerSecond = (rate: number): number => Math.min(mostDrops, Math.max(0, rate) / dropM3);

/** Null: it does not stream. */
export function streamOf(rate: number): Timbre | null {
  if (!(rate > streamFrom)) return null;
  const strength = Math.sqrt(Math.min(1, rate / fullRate));
  return { hz: 700 + 250 * strength, q: 0.7, level: 0.06 * strength, depth: 0.45 };
}

export class BleedingVoice {
  private readonly stream: HeldNoise;

  constructor(private readonly place: Place) {
    this.stream = new HeldNoise(place);
  }

  /** size: 0 to 1. */
  drop(at: number, size: number): void {
    drip(this.place, at, size, 0.035 + 0.02 * size);
  }

  /** The stream at this rate, m3/s, or none. */
  play(rate: number, at: number): void {
    const timbre = streamOf(rate);
    if (timbre) this.stream.play(timbre, at);
    else this.stream.stop(at);
  }

  stop(at: number): void {
    this.stream.stop(at);
  }
}
