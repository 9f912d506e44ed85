// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of the wall of a case: the name of a region, and what an author's choice does to the list.
import { expect, test } from 'vitest';
import { chosenValue, proposedValue, regionOf, withWall } from '../src/studio/wall_changes';

const neck = { regions: 'neck', thicknessMm: 0.25, youngMpa: 1.2 };

test('all vessels are changed together, what is of the aneurysm alone', () => {
  expect(regionOf({ ...neck, regions: 'parent branch_1 ends' })).toBe('vessels');
  expect(regionOf(neck)).toBe('neck');
  expect(proposedValue(neck, 'thickness')).toBe('0.25 mm');
  expect(proposedValue(neck, 'young')).toBe('1.2 MPa');
});

test('a choice replaces the one before it and leaves the others', () => {
  const first = withWall(['bleb.thickness=60 um'], 'neck', 'young', '7 MPa');
  expect(first).toEqual(['bleb.thickness=60 um', 'neck.young=7 MPa']);
  const second = withWall(first, 'neck', 'young', '5 MPa');
  expect(chosenValue(second, 'neck', 'young')).toBe('5 MPa');
  expect(chosenValue(second, 'neck', 'thickness')).toBeNull();
  expect(withWall(second, 'neck', 'young', null)).toEqual(['bleb.thickness=60 um']);
});

test('the last of two choices of a region counts, as for the case builder', () => {
  expect(chosenValue(['neck.young=1 MPa', 'neck.young=2 MPa'], 'neck', 'young')).toBe('2 MPa');
});
