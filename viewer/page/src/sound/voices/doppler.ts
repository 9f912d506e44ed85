// SPDX-License-Identifier: GPL-3.0-or-later
// A Doppler probe. Its pitch is the real shift: at 20 MHz the blood of small arteries lies in the range of hearing.
// Over a section of a vessel the speed of a steady flow is a parabola, v = 2 V (1 - (r/R)^2). Each speed from 0 to 2 V
// takes the same part of the section, so the spectrum is flat from 0 to twice the shift f of the mean speed V. It is
// noise below 2 f. The power of all blood is the same however fast it moves, so the density falls as 1 / f. A wall
// filter takes away what is slow.
//
// Ultrasound is weakened on its way out and back, at 20 MHz by about 2 dB in a millimetre of soft tissue. Blood that
// comes nearer is heard on the right, what goes away on the left, and what moves both ways in the middle.
//
// Source: Evans and McDicken, Doppler Ultrasound, 2000.
import { HeldNoise, type Timbre } from '../held_noise';
import type { Place } from '../mixer';

export interface Flow {
  /** Of the mean speed; positive: nearer, Hz. */
  shiftHz: number;
  /** From the probe, m; null: not known. */
  depthM: number | null;
  /** It moves both ways, as in a sac. */
  mixed: boolean;
}

/** Of the wall filter, Hz. */
export const wallHz = 100;
/** Of what the ear and a loudspeaker have, Hz. */
const highestHz = 14000;
/** At this end of the spectrum the level is the full one, Hz. */
const usualHz = 4000;
const fullLevel = 0.14;
/** At 20 MHz, there and back, dB/m. */
const lossDb = 2000;
/** How far to one side. */
const aside = 0.7;

/** Null: nothing is heard. */
export function timbreOf({ shiftHz, depthM }: Flow): Timbre | null {
  const end = Math.min(highestHz, 2 * Math.abs(shiftHz));
  if (!(end > wallHz)) return null;
  const weakened = 10 ** ((-lossDb * Math.max(0, depthM ?? 0)) / 20);
  const slow = Math.sqrt(1 - wallHz / end);
  return { hz: end, q: -3, level: fullLevel * weakened * slow * Math.sqrt(usualHz / Math.max(end, 400)), depth: 0.08 };
}

export const sideOf = ({ shiftHz, mixed }: Flow): number => (mixed ? 0 : aside * Math.sign(shiftHz));

/** Of changes of the side, s. */
const glideS = 0.03;

export class DopplerVoice {
  private readonly noise: HeldNoise;
  private readonly side: StereoPannerNode;

  constructor(place: Place) {
    const { context, out } = place;
    const wall = context.createBiquadFilter();
    wall.type = 'highpass';
    wall.frequency.value = wallHz;
    this.side = context.createStereoPanner();
    wall.connect(this.side).connect(out);
    // Two stages: 24 dB for each octave above the end of the spectrum.
    this.noise = new HeldNoise({ ...place, out: wall }, { type: 'lowpass', stages: 2 });
  }

  /** Whether it sounds already. */
  get on(): boolean {
    return this.noise.on;
  }

  play(flow: Flow, at: number): void {
    const timbre = timbreOf(flow);
    if (!timbre) return this.stop(at);
    this.side.pan.setTargetAtTime(sideOf(flow), at, glideS);
    this.noise.play(timbre, at);
  }

  stop(at: number): void {
    this.noise.stop(at);
  }
}
