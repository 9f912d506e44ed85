// SPDX-License-Identifier: GPL-3.0-or-later
// What slow machines draw instead.
import * as THREE from 'three';
import { describe, expect, it, vi } from 'vitest';
import { Detail } from '../src/detail';
import { setCheapMaterial } from '../src/materials/cheap';

/** From the surface to each vertex that it leaves out, m. */
function farthest(fine: THREE.BufferGeometry): number {
  const at = fine.getAttribute('position');
  const index = fine.index!.array;
  const corner = (k: number) => new THREE.Vector3().fromBufferAttribute(at, index[k]!);
  const triangles = Array.from(
    { length: index.length / 3 },
    (_, t) => new THREE.Triangle(corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)),
  );
  let far = 0;
  for (let v = 0; v < at.count; v++) {
    const p = new THREE.Vector3().fromBufferAttribute(at, v);
    const near = triangles.map((t) => t.closestPointToPoint(p, new THREE.Vector3()).distanceTo(p));
    far = Math.max(far, Math.min(...near));
  }
  return far;
}

describe('a coarse surface', () => {
  it('has fewer triangles and lies within twice the tolerance', async () => {
    const ball = new THREE.SphereGeometry(0.012, 64, 32);
    const fine = ball.index!;
    const detail = new Detail();
    detail.add(ball);
    let count = fine.count;
    for (const toleranceM of [6e-5, 2.5e-4]) {
      const before = ball.index;
      detail.setCoarse(toleranceM);
      await vi.waitFor(() => expect(ball.index).not.toBe(before));
      expect(ball.index!.count).toBeLessThan(0.7 * count);
      expect(farthest(ball)).toBeLessThan(2 * toleranceM);
      count = ball.index!.count;
    }
    detail.setCoarse(0);
    expect(ball.index).toBe(fine);
    // A choice that was taken back meanwhile does not come late.
    detail.setCoarse(6e-5);
    detail.setCoarse(0);
    await new Promise((resolve) => setTimeout(resolve, 20));
    expect(ball.index).toBe(fine);
  });
});

describe('a cheap material', () => {
  it('has no film, shines below it instead, and is as it was afterwards', () => {
    const wet = new THREE.MeshPhysicalMaterial({ roughness: 0.6, clearcoat: 1, clearcoatRoughness: 0.2 });
    setCheapMaterial(wet, true);
    expect(wet.clearcoat).toBe(1);
    wet.userData.has_cheap = true;
    setCheapMaterial(wet, true);
    setCheapMaterial(wet, true);
    expect(wet.clearcoat).toBe(0);
    expect(wet.roughness).toBeCloseTo(0.36);
    setCheapMaterial(wet, false);
    expect([wet.clearcoat, wet.roughness]).toEqual([1, 0.6]);
  });
});
