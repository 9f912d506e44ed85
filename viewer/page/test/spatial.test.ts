// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbourhood queries against all pairs.
import { describe, expect, it } from 'vitest';
import { PointGrid } from '../src/spatial';

let state = 11;
const random = () => (state = (state * 48271) % 2147483647) / 2147483647;
const cloud = (n: number, scale: number) => Float32Array.from({ length: 3 * n }, () => scale * (random() - 0.5));

const found = (grid: PointGrid, at: readonly number[], radius: number) => {
  const out: number[] = [];
  grid.near(at[0]!, at[1]!, at[2]!, radius, (i) => out.push(i));
  return out.sort((a, b) => a - b);
};
const within = (points: Float32Array, at: readonly number[], radius: number) =>
  Array.from({ length: points.length / 3 }, (_, i) => i).filter(
    (i) => [0, 1, 2].reduce((d2, k) => d2 + (points[3 * i + k]! - at[k]!) ** 2, 0) <= radius * radius,
  );

describe('points in a grid', () => {
  it('finds what is within a radius, from inside and outside, for any cell size', () => {
    const points = cloud(400, 2);
    for (const size of [0.05, 0.3, 5]) {
      const grid = new PointGrid(points, size);
      for (let k = 0; k < 60; k++) {
        const at = [0, 1, 2].map(() => 3 * (random() - 0.5));
        const radius = 0.8 * random();
        expect(found(grid, at, radius)).toEqual(within(points, at, radius));
      }
    }
  });
  it('finds the nearest one, or none', () => {
    const grid = new PointGrid(Float32Array.of(0, 0, 0, 1, 0, 0, 5, 5, 5), 0.5);
    expect(grid.nearest(0.7, 0, 0, 1)).toBe(1);
    expect(grid.nearest(3, 3, 3, 1)).toBe(-1);
    expect(new PointGrid(new Float32Array(0), 1).nearest(0, 0, 0, 9)).toBe(-1);
  });
  it('takes larger cells where points lie far apart', () => {
    const points = Float32Array.of(0, 0, 0, 1e3, 1e3, 1e3, 1e3, 0, 0);
    expect(found(new PointGrid(points, 1e-3), [1e3, 0, 0], 1)).toEqual([2]);
  });
});
