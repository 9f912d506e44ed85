// SPDX-License-Identifier: GPL-3.0-or-later
// Building blocks of short sounds: a gain that rises and dies away, a burst of noise, and a body that rings.
import type { Place } from './mixer';

/** Where a sound that dies away ends, as a share of its peak: -60 dB. */
const silence = 0.001;
/** Shorter rises click. */
const leastRiseS = 0.0008;

/** Rises to its peak, then falls by 60 dB in `fallS`. What enters it ends by itself. */
export function dying(
  { context, out }: Place,
  at: number,
  { peak, riseS = leastRiseS, fallS }: Pick<Mode, 'peak' | 'riseS' | 'fallS'>,
): { gain: GainNode; end: number } {
  const gain = context.createGain();
  const top = at + Math.max(leastRiseS, riseS);
  gain.gain.setValueAtTime(0, at);
  gain.gain.linearRampToValueAtTime(peak, top);
  gain.gain.exponentialRampToValueAtTime(peak * silence, top + fallS);
  gain.connect(out);
  return { gain, end: top + fallS };
}

/** White noise in a loop; who starts it draws the place where it begins, so that it differs each time. */
export function noiseSource({ context, noise }: Place): AudioBufferSourceNode {
  const source = context.createBufferSource();
  source.buffer = noise.white;
  source.loop = true;
  return source;
}

export interface Burst {
  type: BiquadFilterType;
  hz: number;
  q: number;
  peak: number;
  fallS: number;
}

/** Filtered noise that dies away. */
export function burst(place: Place, at: number, { type, hz, q, peak, fallS }: Burst): void {
  const { gain, end } = dying(place, at, { peak, fallS });
  const source = noiseSource(place);
  const filter = place.context.createBiquadFilter();
  filter.type = type;
  filter.frequency.value = hz;
  filter.Q.value = q;
  source.connect(filter).connect(gain);
  source.start(at, Math.random() * place.noise.white.duration);
  source.stop(end);
}

/** A natural tone of a body that is struck. */
export interface Mode {
  hz: number;
  peak: number;
  riseS?: number;
  fallS: number;
}

/** The sum of its modes, each a sine that dies away: how a small stiff body sounds when it is struck. */
export function ring(place: Place, at: number, modes: readonly Mode[]): void {
  for (const { hz, ...shape } of modes) {
    const { gain, end } = dying(place, at, shape);
    const tone = place.context.createOscillator();
    tone.frequency.value = hz;
    tone.connect(gain);
    tone.start(at);
    tone.stop(end);
  }
}
