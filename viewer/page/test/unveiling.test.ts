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
  it('shows the meshes of four more programs in each picture', () => {
    const meshes = ['a', 'a', 'b', 'c', 'd', 'e', 'f'].map(meshWith);
    const camera = new THREE.PerspectiveCamera();
    const seen = () => meshes.map((m) => (m.layers.test(camera.layers) ? '+' : '-')).join('');
    const unveiling = new Unveiling(meshes);
    expect(seen()).toBe('-------');
    unveiling.begin();
    expect(seen()).toBe('+++++--');
    expect(unveiling.end()).toBe(true);
    unveiling.begin();
    expect(seen()).toBe('+++++++');
    expect(unveiling.end()).toBe(false);
  });

  it('draws what is not in the picture yet once without size, with all that belongs to it', () => {
    const blade = meshWith('a');
    const handle = meshWith('a');
    const tool = new THREE.Group();
    tool.scale.set(1, 2, 3);
    tool.visible = false;
    tool.add(blade, handle);
    const unveiling = new Unveiling([blade, handle]);
    unveiling.begin();
    tool.updateMatrixWorld(true);
    expect(tool.visible).toBe(true);
    for (const part of [blade, handle]) expect(part.getWorldScale(new THREE.Vector3()).length()).toBe(0);
    expect(blade.frustumCulled).toBe(false);
    expect(unveiling.end()).toBe(false);
    expect(tool.visible).toBe(false);
    expect(tool.scale.toArray()).toEqual([1, 2, 3]);
    expect(blade.frustumCulled).toBe(true);
  });
});
