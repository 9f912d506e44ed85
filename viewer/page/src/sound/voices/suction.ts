// SPDX-License-Identifier: GPL-3.0-or-later
// A suction tube, by what it draws:
//
//   air        an even hiss about 1.7 kHz: turbulence at the opening
//   fluid      a gurgle about 600 Hz, uneven, with bubbles: slugs of fluid and air in the tube
//   tissue     a dull hum about 240 Hz: the opening is closed, and only the pump is heard
import { HeldNoise, type Timbre } from '../held_noise';
import type { Place } from '../mixer';
import { drip } from './drop';

export type Drawn = 'air' | 'fluid' | 'tissue';

export const timbres: Record<Drawn, Timbre> = {
  air: { hz: 1700, q: 0.7, level: 0.055, depth: 0.06 },
  fluid: { hz: 600, q: 1, level: 0.16, depth: 0.9 },
  tissue: { hz: 240, q: 1.8, level: 0.2, depth: 0.15 },
};

/** Bubbles a second while it draws fluid. */
export const bubbleRate = 14;

export class SuctionVoice {
  private readonly noise: HeldNoise;

  constructor(private readonly place: Place) {
    this.noise = new HeldNoise(place);
  }

  /** Whether it sounds already. */
  get on(): boolean {
    return this.noise.on;
  }

  play(drawn: Drawn, at: number): void {
    this.noise.play(timbres[drawn], at);
  }

  bubble(at: number, size: number): void {
    drip(this.place, at, size, 0.03);
  }

  stop(at: number): void {
    this.noise.stop(at);
  }
}
