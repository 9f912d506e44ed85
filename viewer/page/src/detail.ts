// SPDX-License-Identifier: GPL-3.0-or-later
// Fewer triangles of the same vertices, for pictures whose pixels are larger than what is left out. Without a graphics
// card, triangles take most of a picture's time.
import * as THREE from 'three';
import type { MeshoptSimplifier } from 'meshoptimizer/simplifier';

type Simplifier = typeof MeshoptSimplifier;
let loading: Promise<void> | null = null;
let simplifier: Simplifier | null = null;

/** It is loaded by pages that need it. */
async function load(): Promise<void> {
  const { MeshoptSimplifier: loaded } = await import('meshoptimizer/simplifier');
  await loaded.ready;
  simplifier = loaded;
}

interface Mesh {
  geometry: THREE.BufferGeometry;
  fine: THREE.BufferAttribute;
  /** By tolerance. */
  coarse: Map<number, THREE.BufferAttribute>;
}

export class Detail {
  private readonly meshes: Mesh[] = [];
  private toleranceM = 0;

  /** An indexed geometry. */
  add(geometry: THREE.BufferGeometry): void {
    this.meshes.push({ geometry, fine: geometry.index!, coarse: new Map() });
    if (this.toleranceM > 0) this.apply();
  }

  /**
   * toleranceM: for the distance between the coarse surface and the fine one, as an estimate; distances reach twice
   * that. 0: the fine surfaces. Coarse ones appear as soon as they are made; until then the fine ones are drawn.
   */
  setCoarse(toleranceM: number): void {
    if (toleranceM === this.toleranceM) return;
    this.toleranceM = toleranceM;
    this.apply();
  }

  private apply(): void {
    const { toleranceM } = this;
    if (toleranceM === 0) {
      for (const { geometry, fine } of this.meshes) geometry.setIndex(fine);
      return;
    }
    if (!simplifier) {
      loading ??= load();
      void loading.then(() => this.apply());
      return;
    }
    for (const { geometry, fine, coarse } of this.meshes) {
      let index = coarse.get(toleranceM);
      if (!index) {
        const positions = geometry.getAttribute('position').array as Float32Array;
        const all = Uint32Array.from(fine.array);
        const [kept] = simplifier.simplify(all, positions, 3, 0, toleranceM, ['ErrorAbsolute']);
        coarse.set(toleranceM, (index = new THREE.BufferAttribute(kept, 1)));
      }
      if (geometry.index !== index) geometry.setIndex(index);
    }
  }
}
