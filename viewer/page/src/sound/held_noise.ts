// SPDX-License-Identifier: GPL-3.0-or-later
// A lasting noise with a timbre that may change: white noise through a filter, a band-pass unless another is wanted,
// made uneven by slow noise,
//
//   y = level (1 + depth n_slow(t)) * filter(n_white; hz, q).
//
// It lives on a lease: each call of `play` says that it goes on, and without one it falls silent by itself. So nothing
// goes on roaring when the engine stops or the connection breaks.
import { noiseSource } from './envelope';
import type { Place } from './mixer';

export interface Timbre {
  hz: number;
  /** As Web Audio has it: of a low-pass filter in dB. */
  q: number;
  level: number;
  /** 0: even; 1: as uneven as it can be. */
  depth: number;
}

/** Of changes, s. */
const glideS = 0.025;
/** Without a new call it fades after this; pictures of a slow machine are as far apart. */
const leaseS = 0.5;
/** A lease is made longer so often, s. */
const renewS = 0.1;
/** Smaller changes are not heard: shares. */
const heard = 0.08;
/** After that it is off: fades are over. */
const fadeS = 0.3;

/** The filter, and how often one follows the other. */
export interface Filter {
  type: BiquadFilterType;
  stages: number;
}

interface Running {
  sources: AudioBufferSourceNode[];
  filters: BiquadFilterNode[];
  depth: GainNode;
  level: GainNode;
}

const differs = (a: number, b: number): boolean => Math.abs(a - b) > heard * Math.max(Math.abs(a), Math.abs(b));

export class HeldNoise {
  private playing: Timbre | null = null;
  private renewAt = 0;
  private running: Running | null = null;

  constructor(
    private readonly place: Place,
    private readonly filter: Filter = { type: 'bandpass', stages: 1 },
  ) {}

  /** Begins it, changes it, or lets it go on. */
  play(timbre: Timbre, at: number): void {
    const last = this.playing;
    const changed = !last || (['hz', 'q', 'level', 'depth'] as const).some((k) => differs(last[k], timbre[k]));
    if (!changed && at < this.renewAt) return;
    this.playing = timbre;
    this.renewAt = at + renewS;
    const { hz, q, level, depth } = timbre;
    const { filters, depth: uneven, level: loudness } = (this.running ??= this.start(hz, q, at));
    for (const f of filters) {
      f.frequency.setTargetAtTime(hz, at, glideS);
      f.Q.setTargetAtTime(q, at, glideS);
    }
    uneven.gain.setTargetAtTime(depth, at, glideS);
    loudness.gain.cancelScheduledValues(at);
    loudness.gain.setTargetAtTime(level, at, glideS);
    loudness.gain.setTargetAtTime(0, at + leaseS, glideS);
  }

  get on(): boolean {
    return this.running !== null;
  }

  stop(at: number): void {
    if (!this.running) return;
    const { sources, level } = this.running;
    level.gain.cancelScheduledValues(at);
    level.gain.setTargetAtTime(0, at, glideS);
    for (const s of sources) s.stop(at + fadeS);
    this.running = this.playing = null;
  }

  private start(hz: number, q: number, at: number): Running {
    const { context, noise, out } = this.place;
    const source = noiseSource(this.place);
    const wander = context.createBufferSource();
    wander.buffer = noise.slow;
    wander.loop = true;
    const filters = Array.from({ length: this.filter.stages }, () => {
      const filter = context.createBiquadFilter();
      filter.type = this.filter.type;
      filter.frequency.value = hz;
      filter.Q.value = q;
      return filter;
    });
    const depth = context.createGain();
    const unevenness = context.createGain();
    const level = context.createGain();
    level.gain.value = depth.gain.value = 0;
    wander.connect(depth).connect(unevenness.gain);
    const filtered = filters.reduce<AudioNode>((from, to) => from.connect(to), source);
    filtered.connect(unevenness).connect(level).connect(out);
    source.start(at, Math.random() * noise.white.duration);
    wander.start(at);
    return { sources: [source, wander], filters, depth, level };
  }
}
