// SPDX-License-Identifier: GPL-3.0-or-later
import { Vector3 } from 'three';
import { expect, it } from 'vitest';
import type { Choices, Facts } from '../src/studio/api';
import { chosenPlane, planeThrough, planeWithDome } from '../src/studio/neck_plane';
import { forThePage } from '../src/studio/wording';

const v = (...p: [number, number, number]) => new Vector3(...p);
const proposal = (z: number, diameterMm: number) => ({
  ...{ method: 'ostium', diameterMm, agreement: 1, planar: true },
  ...{ centre: [0, 0, z] as [number, number, number], normal: [0, 0, 1] as [number, number, number] },
});
const facts = { proposals: [proposal(2, 4), proposal(3, 5)] } as unknown as Facts;
const choice = (neck: Choices['neck']) => ({ neck }) as Choices;

it('lays the neck through both clicks, turned from the proposal as little as that asks for', () => {
  const [a, b] = [v(-2, 0, 1), v(2, 0.5, 2)];
  const plane = planeThrough(a, b, v(0, 0, 1))!;
  const along = b.clone().sub(a);
  expect(plane.normal.length()).toBeCloseTo(1, 12);
  expect(plane.normal.dot(along)).toBeCloseTo(0, 12);
  // Of all normals across the line, the one nearest to the proposal lies in the plane of both.
  expect(plane.normal.dot(along.clone().cross(v(0, 0, 1)))).toBeCloseTo(0, 12);
  expect(plane.normal.z).toBeGreaterThan(0);
  expect(plane.radius).toBeCloseTo(along.length() / 2, 12);
  expect(plane.centre.distanceTo(v(0, 0.25, 1.5))).toBeCloseTo(0, 12);
});

it('takes no two clicks at one place, and none along the dome', () => {
  expect(planeThrough(v(1, 1, 1), v(1, 1.1, 1), v(0, 0, 1))).toBeNull();
  expect(planeThrough(v(0, 0, 0), v(0.1, 0, 4), v(0, 0, 1))).toBeNull();
});

it('needs no proposal when the dome is shown', () => {
  const plane = planeWithDome([v(-2, 0, 0), v(2, 0, 0), v(0.5, 0, 6)])!;
  expect(plane.normal.distanceTo(v(0, 0, 1))).toBeCloseTo(0, 12);
});

it('follows the choice, else the first proposal', () => {
  expect(chosenPlane(choice(null), facts)).toMatchObject({ radius: 2 });
  const other = chosenPlane(choice({ plane: [0, 0, 3, 0, 0, 2] }), facts)!;
  expect(other.radius).toBe(2.5);
  expect(other.normal.length()).toBeCloseTo(1, 12);
  expect(chosenPlane(choice({ points: [-3, 0, 2, 3, 0, 2] }), facts)!.radius).toBe(3);
  expect(chosenPlane(choice(null), { proposals: [] } as unknown as Facts)).toBeNull();
});

it('says what to do on the page in place of options', () => {
  expect(forThePage('The wall has too few vertices: insula case wall FOLDER --vertices 2400 --on')).toBe(
    'The wall has too few vertices: choose 2400 vertices and build again',
  );
  expect(forThePage('set the neck with --neck "1 2 3 mm 0 0 1" or --neck-points')).toBe('set the neck by two clicks');
});
