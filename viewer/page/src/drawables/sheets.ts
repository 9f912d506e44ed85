// SPDX-License-Identifier: GPL-3.0-or-later
// Membranes between neighbouring fibres, as one instanced mesh: what makes a web of strands a sheet of arachnoid.
import * as THREE from 'three';
import type { DrawableContext } from './drawn';
import { sheetMaterial } from './sheet_material';
import { neighbours } from './web';

const acrossSteps = 5;
const alongSteps = 4;
/** Seconds until a membrane without any fibre has shrunk to a fringe that fades. */
const fadeS = 30;

/** What a membrane reads of its two fibres. */
export interface FibreStates {
  /** Six numbers a line: its first and its last point. */
  ends: Float32Array;
  /** 1 whole ... 0; below 0 parted. */
  whole: Float32Array;
  /** Seconds since the line parted; -1: it stands. */
  age(line: number): number;
  /** How far a line hangs through, m. */
  sag(line: number): number;
}

export class Sheets {
  readonly mesh: THREE.Mesh;
  private readonly geometry = new THREE.InstancedBufferGeometry();
  private pairs: [number, number][] = [];
  private readonly attributes = new Map<string, THREE.InstancedBufferAttribute>();

  constructor(context: DrawableContext) {
    this.buildGrid();
    this.mesh = new THREE.Mesh(this.geometry, sheetMaterial(context.field, context.material));
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 1;
    this.geometry.instanceCount = 0;
  }

  /** Once, when the fibres are known. */
  weave(fibres: FibreStates, count: number): void {
    this.pairs = neighbours(fibres.ends, (i) => fibres.whole[i]! >= 0, count);
    this.geometry.dispose();
    for (const [name, size] of Object.entries({ i_from: 3, i_to: 3, j_from: 3, j_to: 3, state: 4, slack: 3 })) {
      const a = new THREE.InstancedBufferAttribute(new Float32Array(this.pairs.length * size), size);
      this.attributes.set(name, a.setUsage(THREE.DynamicDrawUsage));
      this.geometry.setAttribute(name, a);
    }
  }

  update(fibres: FibreStates, count: number): void {
    let out = 0;
    for (const [k, [i, j]] of this.pairs.entries()) {
      if (i >= count || j >= count) continue;
      const ages = [fibres.age(i), fibres.age(j)] as const;
      // As the fibres themselves: what had parted before the page came is not there.
      if (Math.min(...ages) > fadeS || Math.max(...ages) > 1e5) continue;
      this.put('i_from', out, fibres.ends.subarray(6 * i, 6 * i + 3));
      this.put('i_to', out, fibres.ends.subarray(6 * i + 3, 6 * i + 6));
      this.put('j_from', out, fibres.ends.subarray(6 * j, 6 * j + 3));
      this.put('j_to', out, fibres.ends.subarray(6 * j + 3, 6 * j + 6));
      this.put('state', out, [Math.max(0, fibres.whole[i]!), Math.max(0, fibres.whole[j]!), ...ages]);
      this.put('slack', out, [fibres.sag(i), fibres.sag(j), (k * 0.6180339887) % 1]);
      out++;
    }
    this.geometry.instanceCount = out;
    for (const a of this.attributes.values()) a.needsUpdate = true;
  }

  dispose(): void {
    this.geometry.dispose();
    (this.mesh.material as THREE.Material).dispose();
  }

  private put(name: string, at: number, numbers: ArrayLike<number>): void {
    const a = this.attributes.get(name)!;
    a.array.set(numbers, at * a.itemSize);
  }

  /** Two halves that part in the middle: position = (across, along, half). */
  private buildGrid(): void {
    const position: number[] = [];
    const index: number[] = [];
    for (const half of [0, 1])
      for (let t = 0; t <= alongSteps; t++)
        for (let s = 0; s <= acrossSteps; s++) {
          const here = position.length / 3;
          position.push(s / acrossSteps, 0.5 * (half + t / alongSteps), half);
          if (t === alongSteps || s === acrossSteps) continue;
          const above = here + acrossSteps + 1;
          index.push(here, here + 1, above, here + 1, above + 1, above);
        }
    this.geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
    this.geometry.setIndex(index);
  }
}
