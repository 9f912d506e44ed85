// SPDX-License-Identifier: GPL-3.0-or-later
// A strand or a piece of membrane parts, or a vessel with its blood. Cut by an edge it is one short snip. Torn it is a
// longer, lower and louder rip, since tearing is a fault. A rip is noise in crackles that follow each other ever faster
// (fibre by fibre, the rest gives way sooner).
//
//            cut                                     torn
//   strand   a snip at 5 kHz                         a rip that falls from 1000 to 350 Hz, over a thud
//   vein     a wet snip at 2.6 kHz, a soft pop       a rip that falls from 700 to 220 Hz, a full pop
//   artery   a sharp snap at 2.4 kHz                 a rip that falls from 2600 to 1500 Hz, into the snap
//
// A vein's pop lies at 300 Hz, and bubbles of the dark blood that wells up follow. An artery goes on with the hiss of
// its jet, which begins at 3000 Hz and dies away in a quarter of a second.
import { burst, dying, noiseSource } from '../envelope';
import type { Place } from '../mixer';
import type { Parting } from '../table';
import { drip } from './drop';

type Part = (place: Place, at: number, vary: number) => void;

/** When each crackle of a rip begins, s: so that strands that part together are not one loud click. */
const crackles = [0, 0.034, 0.061, 0.082, 0.098, 0.11];
const ripS = 0.17;

interface Rip {
  fromHz: number;
  toHz: number;
  peak: number;
}

function rip(place: Place, at: number, { fromHz, toHz, peak }: Rip): void {
  const { context, noise, out } = place;
  const source = noiseSource(place);
  const filter = context.createBiquadFilter();
  filter.type = 'bandpass';
  filter.Q.value = 1.1;
  filter.frequency.setValueAtTime(fromHz, at);
  filter.frequency.exponentialRampToValueAtTime(toHz, at + ripS);
  const gain = context.createGain();
  gain.gain.setValueAtTime(0, at);
  crackles.forEach((t, k) => {
    gain.gain.setTargetAtTime(peak * (k === 0 ? 1 : 0.55 + 0.3 * (k % 2)), at + t, 0.0012);
    gain.gain.setTargetAtTime(0, at + t + 0.005, 0.009);
  });
  source.connect(filter).connect(gain).connect(out);
  source.start(at, Math.random() * noise.white.duration);
  source.stop(at + ripS);
}

function thud({ context, ...place }: Place, at: number): void {
  const tone = context.createOscillator();
  tone.frequency.setValueAtTime(150, at);
  tone.frequency.exponentialRampToValueAtTime(70, at + 0.08);
  const { gain, end } = dying({ context, ...place }, at, { peak: 0.14, riseS: 0.004, fallS: 0.11 });
  tone.connect(gain);
  tone.start(at);
  tone.stop(end);
}

/** When its bubbles burst, s after it parts, and their sizes. */
const bubbles = [
  { afterS: 0.07, size: 0.9 },
  { afterS: 0.15, size: 0.6 },
  { afterS: 0.21, size: 0.8 },
];

function wellUp(place: Place, at: number, vary: number, peak: number): void {
  burst(place, at, { type: 'bandpass', hz: 300 * (1 + 0.1 * vary), q: 1.4, peak, fallS: 0.09 });
  for (const { afterS, size } of bubbles) drip(place, at + afterS, size, 0.02);
}

function spurt(place: Place, at: number, vary: number): void {
  burst(place, at, { type: 'bandpass', hz: 2400 * (1 + 0.1 * vary), q: 1.2, peak: 0.5, fallS: 0.03 });
  burst(place, at + 0.012, { type: 'bandpass', hz: 3000 * (1 + 0.1 * vary), q: 0.6, peak: 0.25, fallS: 0.25 });
}

const partings: Record<Parting['what'], Record<Parting['by'], Part>> = {
  strand: {
    cut: (place, at, vary) =>
      burst(place, at, { type: 'bandpass', hz: 5000 + 800 * vary, q: 0.9, peak: 0.18, fallS: 0.035 }),
    torn: (place, at, vary) => {
      rip(place, at, { fromHz: 1000 * (1 + 0.15 * vary), toHz: 350, peak: 0.42 });
      thud(place, at);
    },
  },
  vein: {
    cut: (place, at, vary) => {
      burst(place, at, { type: 'bandpass', hz: 2600 * (1 + 0.1 * vary), q: 0.9, peak: 0.3, fallS: 0.04 });
      wellUp(place, at + 0.02, vary, 0.5);
    },
    torn: (place, at, vary) => {
      rip(place, at, { fromHz: 700 * (1 + 0.1 * vary), toHz: 220, peak: 0.5 });
      wellUp(place, at + crackles[5]!, vary, 1.4);
    },
  },
  artery: {
    cut: spurt,
    torn: (place, at, vary) => {
      rip(place, at, { fromHz: 2600 * (1 + 0.1 * vary), toHz: 1500, peak: 0.3 });
      spurt(place, at + crackles[5]!, vary);
    },
  },
};

/** vary: -1 to 1, another pitch and strength each time. */
export function part(place: Place, at: number, { what, by }: Parting, vary: number): void {
  partings[what][by](place, at, vary);
}
