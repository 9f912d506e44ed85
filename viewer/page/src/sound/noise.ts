// SPDX-License-Identifier: GPL-3.0-or-later
// Noise of a context, made once and played in loops: all voices share it.
import { makeRandom } from '../random';

/** Long enough that nobody hears it come back. */
const lengthS = 2;
/** The slow noise follows a new number so many times a second. */
const slowHz = 12;

export interface Noise {
  /** White, -1 to 1. */
  white: AudioBuffer;
  /** Wanders between -1 and 1 about as fast as fluid gurgles. */
  slow: AudioBuffer;
}

export function makeNoise(context: BaseAudioContext): Noise {
  const rate = context.sampleRate;
  const random = makeRandom(7);
  const draw = () => 2 * random() - 1;
  const n = Math.round(lengthS * rate);
  const white = context.createBuffer(1, n, rate);
  const samples = white.getChannelData(0);
  for (let i = 0; i < n; i++) samples[i] = draw();
  const slow = context.createBuffer(1, n, rate);
  const wave = slow.getChannelData(0);
  const knots = Array.from({ length: lengthS * slowHz }, draw);
  for (let i = 0; i < n; i++) {
    const at = (i / n) * knots.length;
    const k = Math.floor(at);
    const share = 0.5 - 0.5 * Math.cos(Math.PI * (at - k));
    // The last knot leads back to the first one, so the loop has no seam.
    wave[i] = knots[k]! * (1 - share) + knots[(k + 1) % knots.length]! * share;
  }
  return { white, slow };
}
