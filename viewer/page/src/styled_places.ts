// SPDX-License-Identifier: GPL-3.0-or-later
// Places in a frame that drawables of one style mark: points, and the middles of lines.
import * as THREE from 'three';
import type { Bundle } from './bundle_types';
import type { RenderFrame } from './lcm';
import { type DrawableData, type MaterialData, materialOf } from './step_data/declarations';
import { floatsPerElement } from './step_data/drawable_data';

interface Marked {
  declared: DrawableData;
  material: MaterialData;
}

export class StyledPlaces {
  /** By the drawable's index. */
  private readonly marked = new Map<number, Marked>();

  constructor(private readonly style: string) {}

  begin(bundle: Bundle): void {
    this.marked.clear();
    for (const { declared } of bundle.drawables) {
      const material = materialOf(bundle.materials, declared.material);
      const hasPlaces = declared.kind === 'points' || declared.kind === 'polylines';
      if (hasPlaces && material.style === this.style) this.marked.set(declared.index, { declared, material });
    }
  }

  /** The first drawable that marks such places; undefined: there is none. */
  first(): Marked | undefined {
    return this.marked.values().next().value;
  }

  /** The places in a frame, without what is gone. */
  in(frame: Pick<RenderFrame, 'drawable'>): THREE.Vector3[] {
    const out: THREE.Vector3[] = [];
    for (const { index, data } of frame.drawable) {
      const of = this.marked.get(index);
      if (!of) continue;
      const each = floatsPerElement(of.declared);
      for (let k = 0; k + each <= data.length; k += each) {
        if (of.declared.kind === 'polylines' && data[k + 3]! < 0) continue;
        const p = middle(data, k, each);
        if (Number.isFinite(p.lengthSq())) out.push(p);
      }
    }
    return out;
  }
}

/** Of the points of one element, four numbers each. */
function middle(data: ArrayLike<number>, from: number, each: number): THREE.Vector3 {
  const sum = new THREE.Vector3();
  for (let k = from; k < from + each; k += 4) sum.add(new THREE.Vector3(data[k], data[k + 1], data[k + 2]));
  return sum.divideScalar(each / 4);
}
