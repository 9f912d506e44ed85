// SPDX-License-Identifier: GPL-3.0-or-later
// A clip in its applier: small stiff metal that is struck. Each click is a tick of noise and the first bending modes
// of the blades. The modes of a free bar lie at 1 : 2.76 : 5.40, and higher ones die away sooner. The four sounds
// differ in pitch, number and ring:
//
//   loaded     two soft low clicks: the clip seats in the jaws
//   shut       one full click
//   released   one click, higher, and the clip rings on
//   taken      two clicks that rise: the jaws grip it again
import { burst, ring } from '../envelope';
import type { Place } from '../mixer';
import type { ClipSound } from '../table';

const ratios = [1, 2.76, 5.4];

interface Click {
  afterS: number;
  hz: number;
  peak: number;
  ringS: number;
}

const sounds: Record<ClipSound, readonly Click[]> = {
  loaded: [
    { afterS: 0, hz: 900, peak: 0.05, ringS: 0.03 },
    { afterS: 0.07, hz: 1000, peak: 0.06, ringS: 0.03 },
  ],
  shut: [{ afterS: 0, hz: 1350, peak: 0.12, ringS: 0.05 }],
  released: [{ afterS: 0, hz: 2100, peak: 0.1, ringS: 0.22 }],
  taken: [
    { afterS: 0, hz: 1350, peak: 0.07, ringS: 0.04 },
    { afterS: 0.085, hz: 2000, peak: 0.08, ringS: 0.06 },
  ],
};

export function click(place: Place, at: number, how: ClipSound): void {
  for (const { afterS, hz, peak, ringS } of sounds[how]) {
    burst(place, at + afterS, { type: 'bandpass', hz: 2.2 * hz, q: 0.8, peak: 0.8 * peak, fallS: 0.008 });
    ring(
      place,
      at + afterS,
      ratios.map((r, k) => ({ hz: r * hz, peak: peak / (1 + 1.5 * k), fallS: ringS / (1 + 0.8 * k) })),
    );
  }
}
