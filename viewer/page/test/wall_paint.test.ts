// SPDX-License-Identifier: GPL-3.0-or-later
// Painted parts of the wall: strokes and erasers, and which vertices of a surface they cover.
import { expect, test } from 'vitest';
import type { Point } from '../src/studio/api';
import { PatchRegion } from '../src/studio/wall_paint/patch_region';
import {
  adds,
  freshPatch,
  mostPoints,
  wallPatchesOf,
  withoutPlaces,
  withStroke,
  withValue,
} from '../src/studio/wall_paint/patches';

const line = (count: number, step = 1): Point[] => Array.from({ length: count }, (_v, k) => [k * step, 0, 0]);

test('a stroke begins a part or adds to one, to a thousandth of a millimetre', () => {
  const one = withStroke([], 0, [[0.12345, 0, 0]]);
  expect(one).toEqual([{ ...freshPatch(), points: [[0.123, 0, 0]] }]);
  const two = withStroke(one, 1, line(2));
  expect(two.map((p) => p.points.length)).toEqual([1, 2]);
  const more = withStroke(two, 0, [
    [0.123, 0, 0],
    [5, 0, 0],
  ]);
  expect(more[0]!.points).toEqual([
    [0.123, 0, 0],
    [5, 0, 0],
  ]);
  expect(more[1]).toEqual(two[1]);
});

test('a part has a largest number of points', () => {
  expect(withStroke([], 0, line(mostPoints + 7))[0]!.points).toHaveLength(mostPoints);
});

test('a place adds to a stroke from half a radius away', () => {
  expect(adds([[0, 0, 0]], [0.49, 0, 0], 1)).toBe(false);
  expect(adds([[0, 0, 0]], [0.5, 0, 0], 1)).toBe(true);
});

test('an eraser takes the points within the radius, and a part without points goes', () => {
  const painted = withStroke(withStroke([], 0, line(5)), 1, [[9, 0, 0]]);
  const erased = withoutPlaces(painted, 0, [[1, 0, 0]]);
  expect(erased[0]!.points).toEqual([
    [3, 0, 0],
    [4, 0, 0],
  ]);
  expect(erased[1]).toEqual(painted[1]);
  expect(withoutPlaces(painted, 1, [[9, 0.5, 0]])).toEqual([painted[0]]);
});

test('parts come back from their JSON, and a value changes only its own', () => {
  const painted = withStroke(withStroke([], 0, line(2)), 1, line(1));
  const other = withValue(painted, 1, { young: '', thickness: '0.1 mm' });
  expect(wallPatchesOf(JSON.parse(JSON.stringify(other)))).toEqual(other);
  expect(other[0]).toEqual(painted[0]);
  expect(wallPatchesOf('x')).toEqual([]);
});

/** Two square sheets of triangles, one over the other. */
function sheets(n: number, cell: number, gap: number) {
  const positions: number[] = [];
  const triangles: number[] = [];
  for (const z of [0, gap]) {
    const first = positions.length / 3;
    for (let j = 0; j <= n; j++) for (let i = 0; i <= n; i++) positions.push(i * cell, j * cell, z);
    for (let j = 0; j < n; j++)
      for (let i = 0; i < n; i++) {
        const a = first + j * (n + 1) + i;
        triangles.push(a, a + 1, a + n + 2, a, a + n + 2, a + n + 1);
      }
  }
  return { positions, triangles };
}

test('a spot covers a disc of its own side only', () => {
  const { positions, triangles } = sheets(40, 0.1, 0.3);
  const region = new PatchRegion(positions, triangles);
  const patch = { ...freshPatch(), points: [[2, 2, 0.01] as Point], radius_mm: 1 };
  const of = region.patchOfVertices([patch]);
  const expected = of.map((_k, v) => {
    const [x, y, z] = [positions[3 * v]!, positions[3 * v + 1]!, positions[3 * v + 2]!];
    return z === 0 && Math.hypot(x - 2, y - 2, z - 0.01) <= 1 ? 0 : -1;
  });
  expect(of).toEqual(expected);
});

test('the later of two parts lies over the earlier', () => {
  const { positions, triangles } = sheets(10, 0.1, 5);
  const region = new PatchRegion(positions, triangles);
  const at = (x: number) => ({ ...freshPatch(), points: [[x, 0.5, 0] as Point], radius_mm: 0.35 });
  const of = region.patchOfVertices([at(0.3), at(0.7)]);
  const middle = 5 * 11 + 5;
  expect([of[middle - 2], of[middle], of[middle + 2]]).toEqual([0, 1, 1]);
});
