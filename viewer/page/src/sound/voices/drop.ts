// SPDX-License-Identifier: GPL-3.0-or-later
// A drop falls into fluid, or a bubble bursts: the ring of the bubble of air that it draws in (van den Doel, Physically
// based models for liquid sounds, 2005). For a bubble of radius r in metres:
//
//   f0 = 3 / r Hz,   d = 0.13 / r + 0.0072 r^(-3/2) 1/s,   f = f0 (1 + xi d t),   y = a e^(-d t) sin(phase)
//
// The pitch rises as the bubble nears the surface.
import { dying } from '../envelope';
import type { Place } from '../mixer';

/** Of drops in an operating field, m. */
const radiusM: readonly [number, number] = [0.0022, 0.0045];
/** How fast the pitch rises. */
const rise = 0.11;
/** ln(1000): from the rate of decay to the time of 60 dB. */
const decay60 = 6.9;

/** size: 0 to 1, from the smallest to the largest bubble. */
export function drip(place: Place, at: number, size: number, peak: number): void {
  const r = radiusM[0] + size * (radiusM[1] - radiusM[0]);
  const hz = 3 / r;
  const damping = 0.13 / r + 0.0072 * r ** -1.5;
  const { gain, end } = dying(place, at, { peak, riseS: 0.002, fallS: decay60 / damping });
  const tone = place.context.createOscillator();
  tone.frequency.setValueAtTime(hz, at);
  tone.frequency.linearRampToValueAtTime(hz * (1 + rise * damping * (end - at)), end);
  tone.connect(gain);
  tone.start(at);
  tone.stop(end);
}
