// SPDX-License-Identifier: GPL-3.0-or-later
// Scans on the page of the case builder: places of voxels, the part that is kept, its surface, and what a move of the
// threshold costs.
import { expect, it } from 'vitest';
import { Vector3 } from 'three';
import { Block, scanFactsOf, type Vec } from '../src/studio/scan/block';
import { cutThrough, otherSide, partBeyond, smallerSide } from '../src/studio/scan/cut_plane';
import { surfaceNet } from '../src/studio/scan/surface_net';
import { SampledScan, type Stored } from '../src/studio/scan/sampled_scan';
import { mostNodes, vesselGrid, type Wanted } from '../src/studio/scan/vessel_grid';

function voxels(size: Vec, value: (i: number, j: number, k: number) => number): Int16Array {
  const out = new Int16Array(size[0] * size[1] * size[2]);
  let n = 0;
  for (let k = 0; k < size[2]; k++)
    for (let j = 0; j < size[1]; j++) for (let i = 0; i < size[0]; i++) out[n++] = value(i, j, k);
  return out;
}

const gridOf = (stored: Stored, size: Vec, wanted: Wanted) => vesselGrid(new SampledScan(stored, size), wanted);

const whole = (size: Vec, more: Partial<Wanted> = {}): Wanted => ({
  threshold: 50,
  label: null,
  seed: null,
  from: [0, 0, 0],
  to: size.map((n) => n - 1) as Vec,
  strokes: [],
  spacing: [1, 1, 1],
  ...more,
});

/** Two balls, the second one larger. */
const size: Vec = [60, 30, 30];
const balls = voxels(size, (i, j, k) => {
  const away = Math.min(Math.hypot(i - 12, j - 15, k - 15) - 6, Math.hypot(i - 40, j - 15, k - 15) - 9);
  return 50 - 10 * away;
});

it('keeps the largest piece, or the one at the seed', () => {
  const volume = (r: number) => (4 / 3) * Math.PI * r ** 3;
  const count = (part: Uint8Array, mark: number) => part.reduce((n, p) => n + (p === mark ? 1 : 0), 0);
  const largest = gridOf(balls, size, whole(size));
  expect(count(largest.part, 1) / volume(9)).toBeCloseTo(1, 1);
  expect(count(largest.part, 2) / volume(6)).toBeCloseTo(1, 1);
  const seeded = gridOf(balls, size, whole(size, { seed: [12, 20, 15] }));
  expect(count(seeded.part, 1)).toBe(count(largest.part, 2));
  const none = gridOf(balls, size, whole(size, { threshold: 9999 }));
  expect(count(none.part, 0)).toBe(none.part.length);
});

it('makes a closed surface that faces outward, of the right volume', () => {
  const grid = gridOf(balls, size, whole(size));
  const { positions, triangles } = surfaceNet(grid.size, grid.level);
  const p = (v: number) => [0, 1, 2].map((a) => positions[3 * v + a]!) as Vec;
  const uses = new Map<string, number>();
  let volume = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => triangles[t + k]!) as Vec;
    for (const [x, y] of [
      [a, b],
      [b, c],
      [c, a],
    ] as const) {
      uses.set(`${x} ${y}`, (uses.get(`${x} ${y}`) ?? 0) + 1);
    }
    const [u, v, w] = [p(a), p(b), p(c)];
    volume +=
      (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0])) /
      6;
  }
  for (const edge of uses.keys()) {
    const [x, y] = edge.split(' ');
    expect(uses.get(`${y} ${x}`)).toBe(uses.get(edge));
  }
  expect(volume / ((4 / 3) * Math.PI * 9 ** 3)).toBeCloseTo(1, 1);
});

it('closes a vessel that leaves the scan', () => {
  const tube = voxels([20, 12, 12], (_i, j, k) => 50 - 10 * (Math.hypot(j - 6, k - 6) - 3));
  const grid = gridOf(tube, [20, 12, 12], whole([20, 12, 12]));
  const { positions } = surfaceNet(grid.size, grid.level);
  const xs = positions.filter((_x, n) => n % 3 === 0);
  expect(Math.min(...xs)).toBeLessThan(0);
  expect(Math.max(...xs)).toBeGreaterThan(19);
});

it('chooses a label and a part', () => {
  const labels = voxels([20, 10, 10], (i) => (i < 5 ? 1 : i < 15 ? 2 : 0));
  const grid = gridOf(labels, [20, 10, 10], whole([20, 10, 10], { label: 2 }));
  expect(grid.part.filter((p) => p === 1).length).toBe(1000);
  const near = gridOf(labels, [20, 10, 10], whole([20, 10, 10], { label: 2, from: [3, 0, 0], to: [8, 9, 9] }));
  expect(near.size).toEqual([6, 10, 10]);
  expect(near.part.filter((p) => p === 1).length).toBe(400);
});

it('paints and erases balls along lines', () => {
  const volume = 9 * Math.PI * 20 + (4 / 3) * Math.PI * 27;
  const points: Vec[] = [
    [15, 15, 15],
    [35, 15, 15],
  ];
  const empty = whole(size, { threshold: 1e6, strokes: [{ erase: false, radius: 3, points }] });
  const kept = (w: Wanted) => gridOf(balls, size, w).part.reduce((n, p) => n + (p === 1 ? 1 : 0), 0);
  expect(Math.abs(kept(empty) / volume - 1)).toBeLessThan(0.15); // nodes on the border are not inside
  expect(Math.abs(kept({ ...empty, spacing: [1, 1, 0.5] }) / (2 * volume) - 1)).toBeLessThan(0.15);
  expect(kept({ ...empty, strokes: [...empty.strokes, { erase: true, radius: 4, points }] })).toBe(0);
  // A bridge makes one piece of two.
  const plain = kept(whole(size));
  expect(kept(whole(size, { strokes: empty.strokes }))).toBeGreaterThan(plain + 900);
});

/** A move of the threshold reads no voxel again, looks at each node once, and at those of vessels twice more. */
it('does a bounded work for each move of the threshold', () => {
  const large: Vec = [256, 256, 150];
  const stored = voxels(
    large,
    (i, j, k) => ((i * 7 + j * 13 + k * 29) % 100) + (Math.hypot(j - 128, k - 75) < 9 ? 100 : 0),
  );
  const scan = new SampledScan(stored, large);
  vesselGrid(scan, whole(large, { threshold: 90 }));
  expect(scan.read).toBe(stored.length);
  const grid = vesselGrid(scan, whole(large, { threshold: 100 }));
  expect(scan.read).toBe(stored.length);
  const anew = gridOf(stored, large, whole(large, { threshold: 100 }));
  expect(anew.level.findIndex((v, n) => v !== grid.level[n])).toBe(-1);
  expect(Math.max(...grid.size)).toBeLessThanOrEqual(mostNodes);
  expect(grid.step).toBe(2);
  expect(grid.work).toBeLessThanOrEqual(3 * grid.level.length);
  vesselGrid(scan, whole(large, { threshold: 100, label: 7 }));
  vesselGrid(scan, whole(large, { threshold: 100 }));
  expect(scan.read).toBe(3 * stored.length);
});

it('knows where voxels lie', () => {
  const facts = scanFactsOf({
    size: [4, 4, 4],
    values: { least: 0, most: 100 },
    block: {
      size: [4, 5, 6],
      to_world: [0.5, 0.1, 0, -10, -0.1, 0.5, 0, 20, 0, 0, 0.8, 3],
      bytes: 2,
      scale: 2,
      offset: 7,
    },
  })!;
  const bytes = new Int16Array(120).map((_v, n) => n);
  const block = Block.of(facts, bytes.buffer);
  const p = block.world([1, 2, 3]);
  expect(p[0]).toBeCloseTo(-9.3, 12);
  expect(p[2]).toBeCloseTo(5.4, 12);
  expect(block.voxel(p)).toEqual([1, 2, 3]);
  expect(block.valueAt([1, 2, 3])).toBe(7 + 2 * (1 + 4 * (2 + 5 * 3)));
  expect(block.storedOf(block.valueAt([1, 2, 3]))).toBe(69);
  expect(block.voxel([1e9, -1e9, 0])).toEqual([3, 0, 0]);
  expect(block.around(p, 1)).toEqual([
    [0, 1, 2],
    [2, 3, 4],
  ]);
  expect(() => Block.of(facts, new ArrayBuffer(8))).toThrow();
  expect(scanFactsOf(null)).toBeNull();
});

/** A tube of radius 1 along x from -10 to 10, and a second one far aside that the plane crosses too. */
function tubes() {
  const [positions, triangles]: [number[], number[]] = [[], []];
  for (const y0 of [0, 50]) {
    const first = positions.length / 3;
    for (let i = 0; i <= 40; i++)
      for (let a = 0; a < 12; a++)
        positions.push(-10 + i / 2, y0 + Math.cos((a * Math.PI) / 6), Math.sin((a * Math.PI) / 6));
    const at = (i: number, a: number) => first + 12 * i + (a % 12);
    for (let i = 0; i < 40; i++)
      for (let a = 0; a < 12; a++)
        triangles.push(at(i, a), at(i + 1, a), at(i, a + 1), at(i + 1, a), at(i + 1, a + 1), at(i, a + 1));
  }
  return { positions, triangles };
}

/** Seen from z = 100: a line along y at x = 6.2 across the first tube. */
const sight = (across: (y: number) => boolean) => ({
  direction: (share: number) => new Vector3(6.2, -3 + 6 * share, -100).normalize(),
  hits: (share: number) => {
    const y = -3 + 6 * share;
    return across(y) ? [1, -1].map((z) => new Vector3(6.2, y, z * Math.sqrt(1 - y * y))) : [];
  },
});

it('cuts through a drawn line along the view', () => {
  const cut = cutThrough(sight((y) => Math.abs(y) < 1))!;
  expect(cut.point.distanceTo(new Vector3(6.2, 0, 0))).toBeLessThan(0.1);
  expect(Math.abs(cut.normal.x)).toBeGreaterThan(0.99);
  expect(cutThrough(sight(() => false))).toBeNull();
  const { positions, triangles } = tubes();
  const smaller = smallerSide(positions, triangles, cut, null);
  expect(smaller.normal.x).toBeGreaterThan(0.99);
  expect(smallerSide(positions, triangles, smaller, new Vector3(9, 0, 0)).normal.x).toBeLessThan(-0.99);
  const goes = partBeyond(positions, triangles, smaller);
  // Rings at 6.5, 7, ... 10 of this tube; none of the other one.
  expect(goes.reduce((sum, one) => sum + one, 0)).toBe(8 * 12);
  expect(goes.slice(41 * 12).every((one) => one === 0)).toBe(true);
  expect(partBeyond(positions, triangles, otherSide(smaller)).reduce((sum, one) => sum + one, 0)).toBe(33 * 12);
});
