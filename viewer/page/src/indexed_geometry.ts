// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles by the vertices that they share.
import * as THREE from 'three';

export function indexedGeometry(shape: {
  positions: Float32Array;
  normals: Float32Array;
  indices: Uint32Array;
}): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(shape.positions, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(shape.normals, 3));
  geometry.setIndex(new THREE.BufferAttribute(shape.indices, 1));
  return geometry;
}
