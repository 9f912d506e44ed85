// SPDX-License-Identifier: GPL-3.0-or-later
// Fewer triangles of the same vertices, for pictures whose pixels are larger than what is left out. Without a graphics
// card, triangles take most of a picture's time.
import * as THREE from 'three';
import type { MeshoptSimplifier } from 'meshoptimizer/simplifier';

/** For the distance between the coarse surface and the fine one, m. It is an estimate; distances reach 0.1 mm. */
const toleranceM = 6e-5;

type Simplifier = typeof MeshoptSimplifier;
let simplifier: Promise<Simplifier> | null = null;

/** It is loaded by pages that need it. */
async function load(): Promise<Simplifier> {
  const { MeshoptSimplifier: loaded } = await import('meshoptimizer/simplifier');
  await loaded.ready;
  return loaded;
}

export class Detail {
  private readonly meshes: { geometry: THREE.BufferGeometry; fine: THREE.BufferAttribute; coarse?: Uint32Array }[] = [];
  private coarse = false;

  /** An indexed geometry. */
  add(geometry: THREE.BufferGeometry): void {
    this.meshes.push({ geometry, fine: geometry.index! });
    if (this.coarse) void this.reduce();
  }

  /** Coarse surfaces appear as soon as they are made; until then the fine ones are drawn. */
  setCoarse(coarse: boolean): void {
    if (coarse === this.coarse) return;
    this.coarse = coarse;
    if (coarse) void this.reduce();
    else for (const { geometry, fine } of this.meshes) geometry.setIndex(fine);
  }

  private async reduce(): Promise<void> {
    simplifier ??= load();
    const { simplify } = await simplifier;
    if (!this.coarse) return;
    for (const m of this.meshes) {
      const positions = m.geometry.getAttribute('position').array as Float32Array;
      m.coarse ??= simplify(Uint32Array.from(m.fine.array), positions, 3, 0, toleranceM, ['ErrorAbsolute'])[0];
      if (m.geometry.index!.count !== m.coarse.length) m.geometry.setIndex(new THREE.BufferAttribute(m.coarse, 1));
    }
  }
}
