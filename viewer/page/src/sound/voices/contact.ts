// SPDX-License-Identifier: GPL-3.0-or-later
// An instrument hits bone, or another instrument. Bone is heavy and damps: a dull tock of low modes that die at once.
// Steel on steel is a light tink of high modes that ring. A harder hit is louder, and brighter, since a shorter contact
// excites higher modes: the share of mode k is strength^(1 + k / 2).
import { burst, type Mode, ring } from '../envelope';
import type { Place } from '../mixer';

export type Partner = 'bone' | 'instrument';

const modes: Record<Partner, readonly Mode[]> = {
  bone: [
    { hz: 390, peak: 0.13, fallS: 0.05 },
    { hz: 870, peak: 0.08, fallS: 0.035 },
    { hz: 1620, peak: 0.05, fallS: 0.022 },
  ],
  instrument: [
    { hz: 2650, peak: 0.05, fallS: 0.16 },
    { hz: 4210, peak: 0.035, fallS: 0.12 },
    { hz: 6890, peak: 0.025, fallS: 0.08 },
  ],
};
const ticks: Record<Partner, { hz: number; peak: number; fallS: number }> = {
  bone: { hz: 700, peak: 0.16, fallS: 0.02 },
  instrument: { hz: 5200, peak: 0.05, fallS: 0.006 },
};

/** strength: 0 to 1. vary: -1 to 1, another place of the bodies each time. */
export function hit(place: Place, at: number, partner: Partner, strength: number, vary: number): void {
  const { hz, peak, fallS } = ticks[partner];
  burst(place, at, { type: 'bandpass', hz, q: 0.8, peak: peak * strength, fallS });
  const detuned = 1 + 0.06 * vary;
  ring(
    place,
    at,
    modes[partner].map((m, k) => ({ ...m, hz: m.hz * detuned, peak: m.peak * strength ** (1 + k / 2) })),
  );
}
