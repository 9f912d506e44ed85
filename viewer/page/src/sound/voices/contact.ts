// SPDX-License-Identifier: GPL-3.0-or-later
// An instrument hits something. What is heard follows from what both sides are made of:
//
//   bone      heavy, and damps: a dull tock of low modes that die at once
//   metal     steel or titanium on the same: a light tink of high modes that ring
//   polymer   a dry clack between them
//   soft      tissue, a vessel, a cloth: a faint low pat, without a pitch
//
// A harder hit is louder, and brighter, since a shorter contact excites higher modes: the share of mode k is
// strength^(1 + k / 2).
import { burst, type Mode, ring } from '../envelope';
import type { Place } from '../mixer';

export type Hit = 'bone' | 'metal' | 'polymer' | 'soft';

const modes: Record<Hit, readonly Mode[]> = {
  bone: [
    { hz: 390, peak: 0.13, fallS: 0.05 },
    { hz: 870, peak: 0.08, fallS: 0.035 },
    { hz: 1620, peak: 0.05, fallS: 0.022 },
  ],
  metal: [
    { hz: 2650, peak: 0.05, fallS: 0.16 },
    { hz: 4210, peak: 0.035, fallS: 0.12 },
    { hz: 6890, peak: 0.025, fallS: 0.08 },
  ],
  polymer: [
    { hz: 1150, peak: 0.07, fallS: 0.035 },
    { hz: 2240, peak: 0.05, fallS: 0.025 },
    { hz: 3700, peak: 0.03, fallS: 0.015 },
  ],
  soft: [],
};
const ticks: Record<Hit, { hz: number; q: number; peak: number; fallS: number }> = {
  bone: { hz: 700, q: 0.8, peak: 0.16, fallS: 0.02 },
  metal: { hz: 5200, q: 0.8, peak: 0.05, fallS: 0.006 },
  polymer: { hz: 2400, q: 0.8, peak: 0.07, fallS: 0.01 },
  soft: { hz: 180, q: 1.8, peak: 0.3, fallS: 0.06 },
};

/** strength: 0 to 1. vary: -1 to 1, another place of the bodies each time. */
export function hit(place: Place, at: number, what: Hit, strength: number, vary: number): void {
  const { hz, q, peak, fallS } = ticks[what];
  burst(place, at, { type: 'bandpass', hz, q, peak: peak * strength, fallS });
  const detuned = 1 + 0.06 * vary;
  ring(
    place,
    at,
    modes[what].map((m, k) => ({ ...m, hz: m.hz * detuned, peak: m.peak * strength ** (1 + k / 2) })),
  );
}
