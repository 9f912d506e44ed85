// SPDX-License-Identifier: GPL-3.0-or-later
// The sound of a hint: two soft notes a fourth apart, rising. It is shorter and softer than an alarm, and no alarm of
// IEC 60601-1-8 has two rising notes.
import { ring } from '../envelope';
import type { Place } from '../mixer';

const notes = [
  { afterS: 0, hz: 587 },
  { afterS: 0.11, hz: 784 },
];

export function hint(place: Place, at: number): void {
  for (const { afterS, hz } of notes) ring(place, at + afterS, [{ hz, peak: 0.06, riseS: 0.01, fallS: 0.18 }]);
}
