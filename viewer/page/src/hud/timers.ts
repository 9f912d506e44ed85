// SPDX-License-Identifier: GPL-3.0-or-later
// Countdowns: time left, and how much it presses.
import type { TimerView } from './state';
import { text } from '../languages/text';

export type Urgency = 'calm' | 'soon' | 'over';

/** m:ss, rounded up so that 0:00 means the time is really over; "+m:ss" past it. */
export function timeLeftText(t: Pick<TimerView, 'elapsedS' | 'limitS'>): string {
  if (!(t.limitS > 0)) return minutes(Math.floor(Math.max(0, t.elapsedS)));
  const left = t.limitS - t.elapsedS;
  return left >= 0 ? minutes(Math.ceil(left - 1e-9)) : `+${minutes(Math.floor(-left))}`;
}

/** Amber in the last third, red when over or in the last tenth. */
export function urgency(t: Pick<TimerView, 'elapsedS' | 'limitS'>): Urgency {
  if (!(t.limitS > 0)) return 'calm';
  const left = (t.limitS - t.elapsedS) / t.limitS;
  return left <= 0.1 ? 'over' : left <= 1 / 3 ? 'soon' : 'calm';
}

/** Share of the time that is used, 0..1. */
export function usedShare(t: Pick<TimerView, 'elapsedS' | 'limitS'>): number {
  return t.limitS > 0 ? Math.max(0, Math.min(1, t.elapsedS / t.limitS)) : 0;
}

/** What a headset shows below the field: the note, running clocks, and what was said last. */
export function headsetLines(timers: readonly TimerView[], said: string): string[] {
  const running = timers.filter((t) => t.running).map((t) => `${t.text} ${timeLeftText(t)}`);
  return [text('For training only. Not for patient care.'), running.join('     '), said];
}

const minutes = (seconds: number): string => `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, '0')}`;
