// SPDX-License-Identifier: GPL-3.0-or-later
// What the field's picture is made of, on shapes whose answer is known: which fibres share a membrane, where vessels
// end, how far a tip is from the tissue, when a wall hangs empty.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { distanceText } from '../src/depth_cue';
import { smoothLines } from '../src/drawables/tubes';
import { neighbours, spanM } from '../src/drawables/web';
import { NodeField } from '../src/skinning';
import { TissueProbe } from '../src/tissue_probe';
import { fullness } from '../src/wall';
import { bendEnds, endShift } from '../src/wall_ends';

/** Upright lines, 3 mm long, at places of a plane. */
const upright = (places: [number, number][]): Float32Array =>
  Float32Array.from(places.flatMap(([x, y]) => [x, y, 0, x, y, 0.003]));

describe('membranes', () => {
  const square: [number, number][] = [0, 1, 2].flatMap((i) => [0, 1, 2].map((j): [number, number] => [i, j]));
  const grid = upright(square.map(([i, j]) => [0.001 * i, 0.00101 * j]));

  it('span the sides of a grid and not what lies behind a third fibre', () => {
    const pairs = neighbours(grid, () => true, 9);
    const apart = ([a, b]: [number, number]) =>
      Math.abs(square[a]![0] - square[b]![0]) + Math.abs(square[a]![1] - square[b]![1]);
    // All twelve sides, and no pair with a fibre between.
    expect(pairs.filter((p) => apart(p) === 1)).toHaveLength(12);
    expect(pairs.filter((p) => apart(p) > 2)).toHaveLength(0);
    expect(new Set(pairs.map((p) => p.join())).size).toBe(pairs.length);
    for (const [a, b] of pairs) expect(a).toBeLessThan(b);
  });

  it('leave out parted fibres and reach no farther than their span', () => {
    expect(neighbours(grid, (i) => i !== 4, 9).flat()).not.toContain(4);
    expect(neighbours(upright([[0, 0], [0.99 * spanM, 0]]), () => true, 2)).toHaveLength(1); // prettier-ignore
    expect(neighbours(upright([[0, 0], [1.01 * spanM, 0]]), () => true, 2)).toHaveLength(0); // prettier-ignore
  });
});

describe('smooth lines', () => {
  it('go through the points, and are straight where these are', () => {
    const straight = Float32Array.from([0, 0, 0, 7, 1, 2, 0, 7, 2, 4, 0, 7]);
    const fine = smoothLines(straight, 3);
    expect(fine).toHaveLength(4 * 9);
    for (let q = 0; q < 9; q++) expect(fine[4 * q + 1]).toBeCloseTo(2 * fine[4 * q]!, 6);
    expect([...fine.slice(16, 20)]).toEqual([1, 2, 0, 7]);
    expect([...fine.slice(32)]).toEqual([2, 4, 0, 7]);
  });
});

describe('ends of vessels', () => {
  const end = { centreM: [0, 0, 0] as [number, number, number], outward: [0, 0, 1] as [number, number, number] };
  const cap = { ...end, radiusM: 0.001 };

  it('lead below the tissue that is nearest', () => {
    const tissue = Float32Array.from([0.004, 0, 0, 0, 0.009, 0]);
    const [x, y, z] = endShift(cap, [tissue], [0, 0, -1]);
    // To the tissue and two radii below it; out of the cap by one and a half.
    expect(x).toBeCloseTo(0.006, 9);
    expect(y).toBeCloseTo(0, 9);
    expect(z).toBeCloseTo(0.0015, 9);
    expect(endShift(cap, [], [0, -1, 0])[1]).toBeCloseTo(-0.005, 9);
  });

  it('bend smoothly and leave the rest alone', () => {
    const tube = Float32Array.from([0, -0.001, -0.0059, 0, -0.003, -0.0061, 0.001, 0, -0.003, 0, 0, 0, 0.02, 0, 0]);
    const bent = bendEnds(tube, [cap], [[0.004, 0, 0]]);
    expect(bent[0]).toBeLessThan(1e-5);
    expect([...bent.slice(3, 6)]).toEqual([...tube.slice(3, 6)]);
    // Halfway along the bend: a quarter of the shift.
    expect(bent[6]).toBeCloseTo(0.002, 7);
    expect(bent[9]).toBeCloseTo(0.004, 7);
    expect([...bent.slice(12)]).toEqual([...tube.slice(12)]);
  });
});

describe('the probe', () => {
  const n = 21;
  const places = Array.from({ length: n * n }, (_, i) => [0.001 * ((i % n) - 10), 0.001 * (Math.floor(i / n) - 10), 0]);
  const plane = Float32Array.from(places.flat());
  const normals = Float32Array.from(places.flatMap(() => [0, 0, 1]));

  it('measures the distance to a plane between its vertices too, with its sign', () => {
    const probe = new TissueProbe(plane, normals, null);
    for (const z of [0.004, 0.0007, -0.0004]) {
      const foot = probe.nearest(new THREE.Vector3(0.00043, -0.00227, z), 0.01)!;
      expect(foot.distanceM).toBeCloseTo(z, 9);
      expect(foot.place.z).toBeCloseTo(0, 9);
    }
    expect(probe.nearest(new THREE.Vector3(0, 0, 0.011), 0.01)).toBeNull();
  });

  it('follows tissue that moves', () => {
    const rest = Float32Array.from([0, 0, 0, 0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01]);
    const field = new NodeField(rest, [Uint32Array.from([0, 1, 2, 3])]);
    const count = plane.length / 3;
    const surface = {
      skinNodes: Uint32Array.from({ length: 4 * count }, (_, i) => i % 4),
      skinWeights: Float32Array.from({ length: 4 * count }, (_, i) => (i % 4 === 0 ? 1 : 0)),
    };
    const probe = new TissueProbe(plane, normals, { surface: surface as never, field });
    field.update(rest.map((x, i) => (i % 3 === 2 ? x + 0.002 : x)));
    expect(probe.nearest(new THREE.Vector3(0.0003, 0, 0.005), 0.01)!.distanceM).toBeCloseTo(0.003, 7);
  });

  it('writes half millimetres, and contact', () => {
    expect(distanceText(0.00476)).toBe('5.0 mm');
    expect(distanceText(0.0012)).toBe('1.0 mm');
    expect(distanceText(0.0001)).toBe('contact');
    expect(distanceText(-0.001)).toBe('contact');
  });
});

describe('a wall', () => {
  it('is round at the pressure of arteries and hangs empty without any', () => {
    const mmHg = 133.322;
    expect(fullness(80 * mmHg)).toBe(1);
    expect(fullness(0)).toBe(0);
    expect(fullness(20 * mmHg)).toBeGreaterThan(0.3);
    expect(fullness(20 * mmHg)).toBeLessThan(0.7);
    expect(fullness(null)).toBe(1);
  });
});
