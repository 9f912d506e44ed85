// SPDX-License-Identifier: GPL-3.0-or-later
// What the first pictures of a scene show.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { Unveiling } from '../src/unveiling';

const meshWith = (key: string) => {
  const material = new THREE.MeshBasicMaterial();
  material.customProgramCacheKey = () => key;
  return new THREE.Mesh(new THREE.BufferGeometry(), material);
};

describe('unveiling', () => {
  it('shows the meshes of one more program after each picture', () => {
    const [bone, steel, blade] = [meshWith('bone'), meshWith('steel'), meshWith('steel')];
    const camera = new THREE.PerspectiveCamera();
    const seen = () => [bone, steel, blade].map((m) => m.layers.test(camera.layers));
    const unveiling = new Unveiling([bone, steel, blade]);
    expect(seen()).toEqual([false, false, false]);
    expect(unveiling.next()).toBe(true);
    expect(seen()).toEqual([true, false, false]);
    expect(unveiling.next()).toBe(false);
    expect(seen()).toEqual([true, true, true]);
    expect(unveiling.next()).toBe(false);
  });
});
