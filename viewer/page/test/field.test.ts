// SPDX-License-Identifier: GPL-3.0-or-later
// What the field's picture is made of, on shapes whose answer is known: where vessels end, how far a tip is from the
// tissue, when a wall hangs empty.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { distanceText } from '../src/depth_cue';
import { smoothLines } from '../src/drawables/tubes';
import { NodeField } from '../src/skinning';
import { TissueProbe } from '../src/tissue_probe';
import { fullness } from '../src/wall';
import { bendEnds, endShift } from '../src/wall_ends';

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
