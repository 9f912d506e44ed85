// SPDX-License-Identifier: GPL-3.0-or-later
// The retractors that an author places: how they are read, how fields and gizmo move them, and where they may not
// stand.
import { Vector3 } from 'three';
import { expect, test } from 'vitest';
import { choicesOf } from '../src/studio/choices';
import {
  another,
  depthOf,
  faultOfPlace,
  leanOf,
  placedAs,
  type Retractor,
  type RetractorFacts,
  retractorFactsOf,
  turnOf,
  withDepth,
  withLean,
  withRetractor,
} from '../src/studio/retractors/retractors';

const told = {
  proposed: [
    {
      lobe: 'temporal',
      tip_mm: [54.13, 11.179, -9.821],
      shaft: [0.997, 0.065, 0.039],
      flat: [0.101, -0.624, -0.775],
      pull_mm: 8.4,
    },
    {
      lobe: 'frontal',
      tip_mm: [53.5, 14.958, -0.055],
      shaft: [0.839, 0.185, 0.511],
      flat: [0, -0.148, 0.989],
      pull_mm: 5,
    },
  ],
  lobes: ['frontal', 'temporal'],
  centre: [54, 4, -2],
  radius_mm: 35,
  most: 4,
  most_pull_mm: 15,
  most_lean_deg: 80,
};
const facts = retractorFactsOf(told) as RetractorFacts;
const [temporal, frontal] = facts.proposed as [Retractor, Retractor];
const sight: [number, number, number] = [0.93, 0.25, 0.27];
const neck = new Vector3(48.3, 15.4, -8.7);

test('are read from the case builder and from the choices; without a choice they are those of the approach', () => {
  expect(facts.lobes).toEqual(['frontal', 'temporal']);
  expect(temporal.tip_mm).toEqual([54.13, 11.179, -9.821]);
  expect(retractorFactsOf(undefined)).toBeNull();
  expect(choicesOf({ retractors: [told.proposed[1]] }).retractors).toEqual([frontal]);
  expect(choicesOf({ retractors: [] }).retractors).toEqual([]);
  expect(choicesOf({ retractors: null }).retractors).toBeNull();
});

test('a blade turns with its shaft along z and its flat side along x, and back', () => {
  const turn = turnOf(frontal);
  const z = new Vector3(0, 0, 1).applyQuaternion(turn);
  expect(z.distanceTo(new Vector3(...frontal.shaft).normalize())).toBeLessThan(1e-6);
  const x = new Vector3(1, 0, 0).applyQuaternion(turn);
  expect(Math.abs(x.dot(z))).toBeLessThan(1e-9);
  const flat = new Vector3(...frontal.flat).normalize();
  expect(x.dot(flat), 'as near to the flat side as the shaft lets it').toBeCloseTo(Math.sqrt(1 - z.dot(flat) ** 2), 6);
  const again = placedAs(frontal, new Vector3(1, 2, 3), turn);
  expect(again.tip_mm).toEqual([1, 2, 3]);
  expect(turnOf(again).angleTo(turn)).toBeLessThan(1e-3);
  expect([again.lobe, again.pull_mm]).toEqual(['frontal', 5]);
});

test('is pushed in along its shaft until its tip is as far before the neck as said', () => {
  const before = depthOf(temporal, neck, sight);
  const deeper = withDepth(temporal, neck, sight, before - 2);
  expect(depthOf(deeper, neck, sight)).toBeCloseTo(before - 2, 2);
  const way = new Vector3(...deeper.tip_mm).sub(new Vector3(...temporal.tip_mm));
  expect(
    way
      .clone()
      .normalize()
      .dot(new Vector3(...temporal.shaft).normalize()),
  ).toBeCloseTo(-1, 4);
  expect(deeper.shaft).toEqual(temporal.shaft);
});

test('leans by the angle that is said, its tip where it was and its flat side across', () => {
  for (const degrees of [0, 20, 60]) {
    const leaned = withLean(frontal, sight, degrees);
    expect(leanOf(leaned, sight)).toBeCloseTo(degrees, 1);
    expect(leaned.tip_mm).toEqual(frontal.tip_mm);
    expect(new Vector3(...leaned.flat).dot(new Vector3(...leaned.shaft))).toBeCloseTo(0, 3);
  }
  const straight = withLean(frontal, sight, 0);
  expect(leanOf(withLean(straight, sight, 30), sight)).toBeCloseTo(30, 1);
});

test('may not stand outside of the lobes, nor lean too far', () => {
  expect(facts.proposed.map((r) => faultOfPlace(r, facts, sight))).toEqual(['', '']);
  expect(faultOfPlace({ ...frontal, tip_mm: [54, 4, 34] }, facts, sight)).toBe('outside');
  expect(faultOfPlace(withLean(frontal, sight, 79), facts, sight)).toBe('');
  expect(faultOfPlace(withLean(frontal, sight, 85), facts, sight)).toBe('lean');
});

test('one more is that of a lobe without one, else it stands beside', () => {
  expect(another([temporal], facts)).toEqual(frontal);
  expect(another([], facts)).toEqual(temporal);
  const third = another([temporal, frontal], facts);
  expect(third.lobe).toBe('frontal');
  expect(new Vector3(...third.tip_mm).distanceTo(new Vector3(...frontal.tip_mm))).toBeCloseTo(11, 2);
  expect(faultOfPlace(third, facts, sight)).toBe('');
});

test('one is changed and the others stay', () => {
  expect(withRetractor([temporal, frontal], 1, { pull_mm: 7 })).toEqual([temporal, { ...frontal, pull_mm: 7 }]);
});
