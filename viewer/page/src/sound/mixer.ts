// SPDX-License-Identifier: GPL-3.0-or-later
// Where all voices meet: a gain for each group, the volume, and a limiter, so that nothing clips.
import { type Noise, makeNoise } from './noise';
import { type Group, groups } from './table';

/** What a voice plays into. */
export interface Place {
  context: BaseAudioContext;
  noise: Noise;
  out: AudioNode;
}

/** Below this the limiter changes nothing. */
const knee = 0.6;
/** No sample leaves the page above this. */
export const ceiling = 0.95;
/** Sums of voices above this are cut off. */
const widest = 4;
/** Of changes of a gain, s: no click is heard. */
const glideS = 0.015;

/**
 * y = x up to the knee k, then k + (c - k) tanh((x - k) / (c - k)): smooth, and never above the ceiling c. The
 * compressor of Web Audio would look 6 ms ahead and delay every sound; a curve has no delay.
 */
export function limited(x: number): number {
  const size = Math.abs(x);
  if (size <= knee) return x;
  const room = ceiling - knee;
  return Math.sign(x) * (knee + room * Math.tanh((size - knee) / room));
}

function limiter(context: BaseAudioContext): { first: AudioNode; last: AudioNode } {
  const n = 8193;
  const shaper = context.createWaveShaper();
  shaper.curve = Float32Array.from({ length: n }, (_, i) => limited(widest * ((2 * i) / (n - 1) - 1)));
  const scale = context.createGain();
  scale.gain.value = 1 / widest;
  scale.connect(shaper);
  return { first: scale, last: shaper };
}

export class Mixer {
  private readonly master: GainNode;
  private readonly gains: Record<Group, GainNode>;
  private readonly noise: Noise;

  constructor(readonly context: BaseAudioContext) {
    this.noise = makeNoise(context);
    this.master = context.createGain();
    const { first, last } = limiter(context);
    this.master.connect(first);
    last.connect(context.destination);
    const make = () => {
      const gain = context.createGain();
      gain.connect(this.master);
      return gain;
    };
    this.gains = Object.fromEntries(groups.map((g) => [g, make()])) as Record<Group, GainNode>;
  }

  place(group: Group): Place {
    return { context: this.context, noise: this.noise, out: this.gains[group] };
  }

  /** volume: 0 to 1, as loud as it is felt to be: the gain is its square. */
  set(volume: number, on: Record<Group, boolean>): void {
    const now = this.context.currentTime;
    this.master.gain.setTargetAtTime(volume * volume, now, glideS);
    for (const g of groups) this.gains[g].gain.setTargetAtTime(on[g] ? 1 : 0, now, glideS);
  }
}
