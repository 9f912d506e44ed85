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
  it('shows the meshes of four more programs after each picture', () => {
    const meshes = ['a', 'a', 'b', 'c', 'd', 'e', 'f'].map(meshWith);
    const camera = new THREE.PerspectiveCamera();
    const seen = () => meshes.map((m) => (m.layers.test(camera.layers) ? '+' : '-')).join('');
    // What is not seen costs no program yet.
    meshes[2]!.visible = false;
    const unveiling = new Unveiling(meshes);
    expect(seen()).toBe('-------');
    expect(unveiling.next()).toBe(true);
    expect(seen()).toBe('++++++-');
    expect(unveiling.next()).toBe(false);
    expect(seen()).toBe('+++++++');
    expect(unveiling.next()).toBe(false);
  });
});
