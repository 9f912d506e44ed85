// SPDX-License-Identifier: GPL-3.0-or-later
// Countdowns: time left, and how much it presses.
import type { TimerView } from './state';

export type Urgency = 'calm' | 'soon' | 'over';

/** m:ss, rounded up so that 0:00 means the time is really over; "+m:ss" past it. */
export function time_left_text(t: Pick<TimerView, 'elapsed_s' | 'limit_s'>): string {
  if (!(t.limit_s > 0)) return minutes(Math.floor(Math.max(0, t.elapsed_s)));
  const left = t.limit_s - t.elapsed_s;
  return left >= 0 ? minutes(Math.ceil(left - 1e-9)) : `+${minutes(Math.floor(-left))}`;
}

/** Amber in the last third, red when over or in the last tenth. */
export function urgency(t: Pick<TimerView, 'elapsed_s' | 'limit_s'>): Urgency {
  if (!(t.limit_s > 0)) return 'calm';
  const left = (t.limit_s - t.elapsed_s) / t.limit_s;
  return left <= 0.1 ? 'over' : left <= 1 / 3 ? 'soon' : 'calm';
}

/** Share of the time that is used, 0..1. */
export function used_share(t: Pick<TimerView, 'elapsed_s' | 'limit_s'>): number {
  return t.limit_s > 0 ? Math.max(0, Math.min(1, t.elapsed_s / t.limit_s)) : 0;
}

const minutes = (seconds: number): string => `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, '0')}`;
