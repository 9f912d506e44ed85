// SPDX-License-Identifier: GPL-3.0-or-later
// The servo's figures as the page shows them.
import { describe, expect, it } from 'vitest';
import { barHeights, barTitle, firstLate, hapticText, latenessBoundsUs } from '../src/hud/haptic';
import * as lcm from '../src/lcm';

describe('haptic panel', () => {
  it('has a bar for every count of the message', () => {
    expect(lcm.haptic_status_t.make().lateness_count.length).toBe(latenessBoundsUs.length + 1);
  });

  it('shows one tick among a thousand', () => {
    const counts = [999, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1];
    const heights = barHeights(counts);
    expect(heights[0]).toBeCloseTo(1, 2);
    expect(heights[11]).toBeGreaterThan(0.03);
    expect(heights[5]).toBe(0);
    expect(barHeights([])).toEqual([]);
    expect(barHeights([0, 0])).toEqual([0, 0]);
    expect(barTitle(counts, 11)).toBe('1 ticks of the last second began more than 20000 µs late');
    expect(barTitle(counts, 0)).toBe('999 ticks of the last second began 0 to 10 µs late');
    expect(latenessBoundsUs[firstLate - 1]).toBe(500);
  });

  it('says fresh forces, solve time and sweeps', () => {
    const s = lcm.haptic_status_t.make();
    s.ticks_per_s = 999.6;
    s.fresh_forces_per_s[0] = 998;
    s.solve_us_p99 = 123.4;
    s.sweeps_mean = 7;
    expect(hapticText(s)).toBe('haptics 1000 /s, fresh 998 · 0, solve 123 µs, 7 sweeps');
    expect(hapticText(null)).toBe('haptics –');
  });

  it('says that forces are scaled', () => {
    const s = lcm.haptic_status_t.make();
    s.force_scale = 3;
    expect(hapticText(s)).toMatch(/^forces × 3, haptics /);
    s.force_scale = 1;
    expect(hapticText(s)).toMatch(/^haptics /);
  });
});
