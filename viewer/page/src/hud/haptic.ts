// SPDX-License-Identifier: GPL-3.0-or-later
// How well the servo keeps to its time: figures, the histogram of a second's lateness, and what to do when it does not.
import type { HapticStatus } from '../lcm';
import { el, setText } from './dom';
import { fixed, significant } from '../languages/numbers';
import { said } from '../languages/said';
import { text } from '../languages/text';

/** Upper bounds of lateness_count's entries, microseconds; the last has none (lcm_types/haptic_status.lcm). */
export const latenessBoundsUs = [10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000];

export function hapticText(s: HapticStatus | null): string {
  if (!s) return text('haptics –');
  const scaled =
    s.force_scale > 0 && s.force_scale !== 1
      ? `${text('forces × {scale}', { scale: significant(s.force_scale, 3) })}, `
      : '';
  const fresh = [...s.fresh_forces_per_s].map((f) => f.toFixed(0)).join(' · ');
  const numbers = {
    rate: fixed(s.ticks_per_s, 0),
    fresh,
    time: fixed(s.solve_us_p99, 0),
    sweeps: Math.round(s.sweeps_mean),
  };
  const rates = text('haptics {rate} /s, fresh {fresh}, solve {time} µs, {sweeps} sweeps', numbers);
  return `${scaled}${rates}`;
}

/** Heights of the bars, 0 to 1. One tick among a thousand still shows: the root of the share. */
export function barHeights(counts: readonly number[]): number[] {
  const all = counts.reduce((a, n) => a + n, 0);
  return counts.map((n) => (all > 0 ? Math.sqrt(n / all) : 0));
}

/** From this entry on a tick comes later than half of its millisecond. */
export const firstLate = latenessBoundsUs.indexOf(500) + 1;

export function barTitle(counts: readonly number[], k: number): string {
  const from = k === 0 ? 0 : latenessBoundsUs[k - 1]!;
  const count = counts[k] ?? 0;
  if (k >= latenessBoundsUs.length)
    return text('{count} ticks of the last second began more than {from} µs late', { count, from });
  const to = latenessBoundsUs[k]!;
  return text('{count} ticks of the last second began {from} to {to} µs late', { count, from, to });
}

export class HapticPanel {
  readonly root = el('span', { class: 'haptic' });
  private readonly words = el('span');
  private readonly bars = [...latenessBoundsUs, Infinity].map((_, k) =>
    el('i', k >= firstLate ? { class: 'late' } : {}),
  );
  private readonly advice = el('b', { class: 'advice' });
  private shown: HapticStatus | null | undefined;
  private stood = false;

  constructor() {
    this.root.append(
      this.words,
      el('span', { class: 'histogram', role: 'img', 'aria-label': text('lateness of the servo') }, ...this.bars),
      this.advice,
    );
  }

  /** stands: time stands still on purpose; that no problems come then is no alarm. */
  show(s: HapticStatus | null, stands: boolean): void {
    if (s === this.shown && stands === this.stood) return;
    this.shown = s;
    this.stood = stands;
    setText(this.words, hapticText(s));
    const counts = s ? [...s.lateness_count] : [];
    const heights = barHeights(counts);
    this.bars.forEach((bar, k) => {
      bar.style.height = `${(100 * (heights[k] ?? 0)).toFixed(0)}%`;
      bar.title = barTitle(counts, k);
    });
    setText(this.advice, stands ? '' : said(s?.note ?? ''));
  }
}
