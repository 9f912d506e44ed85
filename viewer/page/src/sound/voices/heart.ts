// SPDX-License-Identifier: GPL-3.0-or-later
// The beep of the patient monitor at each systole. Its pitch tells the mean arterial pressure p, an octave for each
// 60 mmHg:
//
//   f = 620 Hz * 2^((p - 90 mmHg) / 60 mmHg),   kept within 310 and 1240 Hz
//
// so a falling pressure is heard before anybody looks at the monitor. A sine with a little of its octave.
import { ring } from '../envelope';
import type { Place } from '../mixer';

const usualHz = 620;
const usualPa = 90 * 133.322;
const octavePa = 60 * 133.322;

/** pressurePa: mean; null: not known. */
export function pitchOfPressure(pressurePa: number | null): number {
  if (pressurePa === null) return usualHz;
  const octaves = Math.min(1, Math.max(-1, (pressurePa - usualPa) / octavePa));
  return usualHz * 2 ** octaves;
}

export function beep(place: Place, at: number, pressurePa: number | null): void {
  const hz = pitchOfPressure(pressurePa);
  ring(place, at, [
    { hz, peak: 0.07, riseS: 0.008, fallS: 0.14 },
    { hz: 2 * hz, peak: 0.012, riseS: 0.008, fallS: 0.09 },
  ]);
}
