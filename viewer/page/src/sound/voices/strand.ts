// SPDX-License-Identifier: GPL-3.0-or-later
// A strand or a piece of membrane parts. Cut by an edge it is a short bright snip; torn it is a longer, lower and
// louder rip, since tearing is a fault:
//
//   cut    band-passed noise about 5 kHz that falls by 60 dB in 35 ms
//   torn   band-passed noise that falls from 1000 to 350 Hz, in crackles that follow each other ever faster (fibre by
//          fibre, the rest gives way sooner), over a thud that falls from 150 to 70 Hz
//
// A vessel parts with its blood:
//
//   vein     a soft wet pop at 300 Hz, and three bubbles of the dark blood that wells up
//   artery   a sharp snap at 2.4 kHz, and a hiss of the jet that falls from 3000 Hz in a quarter of a second
import { burst, dying, noiseSource } from '../envelope';
import type { Place } from '../mixer';
import type { Parting } from '../table';
import { drip } from './drop';

/** So that strands that part together are not one loud click, s. */
const crackles = [0, 0.034, 0.061, 0.082, 0.098, 0.11];
const ripS = 0.17;

/** vary: -1 to 1, another pitch and strength each time. */
export function part(place: Place, at: number, how: Parting, vary: number): void {
  if (how === 'cut') burst(place, at, { type: 'bandpass', hz: 5000 + 800 * vary, q: 0.9, peak: 0.18, fallS: 0.035 });
  else if (how === 'vein') openVein(place, at, vary);
  else if (how === 'artery') openArtery(place, at, vary);
  else tear(place, at, vary);
}

/** When its bubbles burst, s after it parts, and their sizes. */
const bubbles = [
  { afterS: 0.07, size: 0.9 },
  { afterS: 0.15, size: 0.6 },
  { afterS: 0.21, size: 0.8 },
];

function openVein(place: Place, at: number, vary: number): void {
  burst(place, at, { type: 'bandpass', hz: 300 * (1 + 0.1 * vary), q: 1.4, peak: 0.8, fallS: 0.09 });
  for (const { afterS, size } of bubbles) drip(place, at + afterS, size, 0.05);
}

function openArtery(place: Place, at: number, vary: number): void {
  burst(place, at, { type: 'bandpass', hz: 2400 * (1 + 0.1 * vary), q: 1.2, peak: 0.5, fallS: 0.03 });
  burst(place, at + 0.012, { type: 'bandpass', hz: 3000 * (1 + 0.1 * vary), q: 0.6, peak: 0.25, fallS: 0.25 });
}

function tear(place: Place, at: number, vary: number): void {
  const { context, noise, out } = place;
  const source = noiseSource(place);
  const filter = context.createBiquadFilter();
  filter.type = 'bandpass';
  filter.Q.value = 1.1;
  filter.frequency.setValueAtTime(1000 * (1 + 0.15 * vary), at);
  filter.frequency.exponentialRampToValueAtTime(350, at + ripS);
  const gain = context.createGain();
  gain.gain.setValueAtTime(0, at);
  crackles.forEach((t, k) => {
    const peak = 0.42 * (k === 0 ? 1 : 0.55 + 0.3 * (k % 2));
    gain.gain.setTargetAtTime(peak, at + t, 0.0012);
    gain.gain.setTargetAtTime(0, at + t + 0.005, 0.009);
  });
  source.connect(filter).connect(gain).connect(out);
  source.start(at, Math.random() * noise.white.duration);
  source.stop(at + ripS);
  const thud = context.createOscillator();
  thud.frequency.setValueAtTime(150, at);
  thud.frequency.exponentialRampToValueAtTime(70, at + 0.08);
  const { gain: fall, end } = dying(place, at, { peak: 0.14, riseS: 0.004, fallS: 0.11 });
  thud.connect(fall);
  thud.start(at);
  thud.stop(end);
}
