// SPDX-License-Identifier: GPL-3.0-or-later
// Alarms as IEC 60601-1-8 shapes them: a burst of pulses whose number and speed tell the priority.
//
//   high     3 + 2 pulses, a pause, and the five again; pulses of 0.15 s
//   medium   3 pulses of 0.2 s
//   low      2 pulses of 0.2 s, the second one lower; softer
//
// A pulse has a fundamental between 150 and 1000 Hz and four harmonics of like strength, so that it is placed by the
// ear and heard over other sounds. It rises and falls within a tenth of its length, so that it does not startle.
import type { Place } from '../mixer';
import type { Priority } from '../table';

interface Pattern {
  /** When each pulse begins, and its fundamental. */
  pulses: readonly { atS: number; hz: number }[];
  lengthS: number;
  peak: number;
}

const note = 440;
const lower = 349;
const five = [0, 0.25, 0.5, 0.9, 1.15];

export const patterns: Record<Priority, Pattern> = {
  high: { pulses: [...five, ...five.map((t) => t + 1.8)].map((atS) => ({ atS, hz: note })), lengthS: 0.15, peak: 0.16 },
  medium: { pulses: [0, 0.4, 0.8].map((atS) => ({ atS, hz: note })), lengthS: 0.2, peak: 0.11 },
  low: {
    pulses: [
      { atS: 0, hz: note },
      { atS: 0.4, hz: lower },
    ],
    lengthS: 0.2,
    peak: 0.05,
  },
};

/** Strengths of the harmonics, the fundamental first. */
const harmonics = [1, 0.7, 0.6, 0.5, 0.4];

export class AlarmVoice {
  private readonly wave: PeriodicWave;
  private tone: OscillatorNode | null = null;
  private gain: GainNode | null = null;

  constructor(private readonly place: Place) {
    const imag = Float32Array.from([0, ...harmonics]);
    this.wave = place.context.createPeriodicWave(new Float32Array(imag.length), imag);
  }

  /** In place of a burst that goes on. Returns its length, s. */
  sound(priority: Priority, at: number): number {
    this.stop(at);
    const { context, out } = this.place;
    const { pulses, lengthS, peak } = patterns[priority];
    const tone = context.createOscillator();
    tone.setPeriodicWave(this.wave);
    const gain = context.createGain();
    gain.gain.setValueAtTime(0, at);
    for (const { atS, hz } of pulses) {
      const from = at + atS;
      tone.frequency.setValueAtTime(hz, from);
      gain.gain.setValueAtTime(0, from);
      gain.gain.linearRampToValueAtTime(peak, from + 0.1 * lengthS);
      gain.gain.setValueAtTime(peak, from + 0.7 * lengthS);
      gain.gain.linearRampToValueAtTime(0, from + lengthS);
    }
    tone.connect(gain).connect(out);
    const length = pulses[pulses.length - 1]!.atS + lengthS;
    tone.start(at);
    tone.stop(at + length);
    this.tone = tone;
    this.gain = gain;
    return length;
  }

  stop(at: number): void {
    if (!this.tone || !this.gain) return;
    this.gain.gain.cancelScheduledValues(at);
    this.gain.gain.setTargetAtTime(0, at, 0.01);
    this.tone.stop(at + 0.1);
    this.tone = this.gain = null;
  }
}
