// SPDX-License-Identifier: GPL-3.0-or-later
// All drawables of a scene. One whose numbers are malformed is hidden and reported; the others go on.
import * as THREE from 'three';
import type { Bundle } from '../bundle_types';
import type { FieldUniforms } from '../materials/field';
import type { Playback } from '../playback';
import { DataError, type DrawableData, type MaterialData, materialOf } from '../step_data/declarations';
import type { Drawn, Moment } from './drawn';
import { makeDrawn } from './make';

const isPool = (d: DrawableData, m: MaterialData): boolean => d.kind === 'plane' && m.style === 'fluid';

export class DrawableSet {
  readonly root = new THREE.Group();
  private readonly all: { declared: DrawableData; drawn: Drawn }[] = [];

  constructor(bundle: Bundle, field: FieldUniforms, environment: THREE.Texture | null) {
    const materialFor = (d: DrawableData) => materialOf(bundle.materials, d.material);
    const pools = bundle.drawables.map((d) => d.declared).filter((d) => isPool(d, materialFor(d)));
    // What lies below is veiled once, by the fluid that hides most.
    const clearness = (d: DrawableData) => materialFor(d).translucency;
    const veiling = pools.reduce<DrawableData | null>((a, d) => (a && clearness(a) <= clearness(d) ? a : d), null);
    for (const { declared, meshes } of bundle.drawables) {
      if (materialFor(declared).style === 'aim') continue; // aims.ts shows them, and only to who is led there
      const context = { declared, material: materialFor(declared), meshes, field, environment };
      this.all.push({ declared, drawn: makeDrawn({ ...context, veils: declared === veiling }) });
    }
    // Pools first: jets ask how deep they lie below the surface.
    this.all.sort((a, b) => Number(b.declared.kind === 'plane') - Number(a.declared.kind === 'plane'));
    for (const { drawn } of this.all) this.root.add(drawn.root);
  }

  setCheap(cheap: boolean): void {
    for (const { drawn } of this.all) drawn.setCheap?.(cheap);
  }

  /** Returns what is wrong with the data of this frame, one line a drawable. */
  update(playback: Playback, t: number, moment: Moment): string[] {
    const problems: string[] = [];
    for (const { declared, drawn } of this.all) {
      try {
        const data = playback.drawable(declared, t);
        // A drawable may hide itself in its update.
        drawn.root.visible = data !== null;
        if (data) drawn.update(data, moment);
      } catch (e) {
        if (!(e instanceof DataError)) throw e;
        drawn.root.visible = false;
        problems.push(e.message);
      }
    }
    return problems;
  }

  dispose(): void {
    this.root.removeFromParent();
    for (const { drawn } of this.all) drawn.dispose();
  }
}
