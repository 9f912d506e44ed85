// SPDX-License-Identifier: GPL-3.0-or-later
// A drawable in the picture. Its numbers have been checked (step_data/drawable_data.ts) before it sees them.
import type * as THREE from 'three';
import type { FieldUniforms } from '../materials/field';
import type { DrawableData, MaterialData } from '../step_data/declarations';

export interface Moment {
  /** Of the picture before, s. */
  dt: number;
  /** A steady clock, s. */
  seconds: number;
}

export interface Drawn {
  readonly root: THREE.Object3D;
  update(data: Float32Array, moment: Moment): void;
  /** Less effort for slow machines. */
  setCheap?(cheap: boolean): void;
  dispose(): void;
}

export interface Meshes {
  positions: Float32Array;
  indices: Uint32Array;
  rgba: readonly number[] | null;
}

/** What a drawable is made from. */
export interface DrawableContext {
  declared: DrawableData;
  material: MaterialData;
  meshes: Meshes[];
  field: FieldUniforms;
  environment: THREE.Texture | null;
  /** Of planes of fluid one lies over everything in the field; further ones only show their surface. */
  veils: boolean;
}
