// SPDX-License-Identifier: GPL-3.0-or-later
// A closed clip at the neck: its two blades, and the way from which its applier comes. Millimetres.
import { CapsuleGeometry, Mesh, MeshStandardMaterial, type Object3D, Quaternion, Vector3 } from 'three';
import type { Point } from '../api';
import type { Found } from './trial';

const bladeRadius = 0.4;
const shaftRadius = 0.5;

function rod(from: Point, to: Point, radius: number, color: string, opacity: number): Mesh {
  const [a, b] = [new Vector3(...from), new Vector3(...to)];
  const along = b.clone().sub(a);
  const material = new MeshStandardMaterial({
    color,
    roughness: 0.35,
    metalness: 0.6,
    transparent: opacity < 1,
    opacity,
  });
  const mesh = new Mesh(new CapsuleGeometry(radius, Math.max(0.1, along.length() - 2 * radius), 4, 12), material);
  mesh.position.copy(a).add(b).multiplyScalar(0.5);
  mesh.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), along.normalize()));
  return mesh;
}

export const clipMarks = (found: Found): Object3D[] => [
  ...found.blades.map(([from, to]) => rod(from, to, bladeRadius, '#d8dde2', 1)),
  rod(found.grip, found.shaft, shaftRadius, '#8fa3b5', 0.45),
];
