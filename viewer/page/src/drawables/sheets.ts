// SPDX-License-Identifier: GPL-3.0-or-later
// Polylines of the style "sheet": pieces of a thin membrane, each spanned between two fibres. A line is the tip of the
// piece's tent, both ends of one fibre, and both ends of its neighbour. The tip's value falls from 1 to 0 as the piece
// wears and is below 0 when it has parted; the ends' values say the same of their fibres. All pieces are one instanced
// mesh (sheet_material.ts).
import * as THREE from 'three';
import type { DrawableContext, Drawn, Moment } from './drawn';
import { sheetMaterial } from './sheet_material';
import { tentOf } from './tent';

/** Points of a line, and its numbers. */
export const sheetPoints = 5;
const each = 4 * sheetPoints;
/** Steps of the mesh; even, so that a line of it passes through the tip. */
const acrossSteps = 8;
const alongStepsPerHalf = 5;
/** Seconds until a piece without any fibre has shrunk to a fringe that fades. */
const fadeS = 30;
/** A tent lower than this is none, m. */
const flat = 2e-5;

const sizes = { i_from: 3, i_to: 3, j_from: 3, j_to: 3, state: 4, slack: 3, rise: 3, tent: 4 };

/** When something parted, by a steady clock; it may stand. */
class Parting {
  private readonly at: Float64Array;
  private readonly seen: Uint8Array;

  constructor(count: number) {
    this.at = new Float64Array(count).fill(Infinity);
    this.seen = new Uint8Array(count);
  }

  /** Seconds since it parted, -1: it stands. What had parted before it was first seen parted long ago. */
  age(i: number, value: number, seconds: number): number {
    if (value >= 0) this.at[i] = Infinity;
    else if (this.at[i] === Infinity) this.at[i] = this.seen[i] ? seconds : seconds - 1e6;
    this.seen[i] = 1;
    return value >= 0 ? -1 : seconds - this.at[i]!;
  }
}

export class Sheets implements Drawn {
  readonly root: THREE.Mesh;
  private readonly geometry = new THREE.InstancedBufferGeometry();
  private readonly attributes = new Map<string, THREE.InstancedBufferAttribute>();
  private count = 0;
  private restLength = new Float32Array(0);
  /** Of each piece: itself, its fibres. */
  private parting = new Parting(0);
  /** Where the tent of each piece last was: what tears, tears from there. */
  private lastTent = new Float32Array(0);

  constructor(context: DrawableContext) {
    this.buildGrid();
    this.allocate(context.declared.count);
    this.root = new THREE.Mesh(this.geometry, sheetMaterial(context.field, context.material));
    this.root.frustumCulled = false;
    this.root.renderOrder = 1;
  }

  update(data: Float32Array, { seconds }: Moment): void {
    const n = data.length / each;
    if (n !== this.count) this.allocate(n);
    let out = 0;
    for (let i = 0; i < n; i++) if (this.write(data.subarray(i * each, (i + 1) * each), i, out, seconds)) out++;
    this.geometry.instanceCount = out;
    for (const a of this.attributes.values()) a.needsUpdate = true;
  }

  dispose(): void {
    this.root.removeFromParent();
    this.geometry.dispose();
    (this.root.material as THREE.Material).dispose();
  }

  /** False when nothing is left of it. */
  private write(line: Float32Array, i: number, out: number, seconds: number): boolean {
    const [whole, first, second] = [line[3]!, line[7]!, line[15]!];
    const torn = this.parting.age(3 * i, whole, seconds);
    const ages = [this.parting.age(3 * i + 1, first, seconds), this.parting.age(3 * i + 2, second, seconds)] as const;
    for (const fibre of [0, 1]) this.restLength[2 * i + fibre] ||= length(line, fibre);
    // As the fibres themselves: what had parted before the page came is not there.
    if (torn > 1e5 || Math.max(...ages) > 1e5) return false;
    if (torn > fadeS && Math.min(...ages) > fadeS) return false;
    const corners = [1, 2, 3, 4].flatMap((p) => [line[4 * p]!, line[4 * p + 1]!, line[4 * p + 2]!]);
    const { s, t, rise } = whole >= 0 ? tentOf(corners, line) : { s: 0.5, t: 0.5, rise: [0, 0, 0] };
    const depth = Math.hypot(...rise);
    if (depth > flat) this.lastTent.set([s, t], 2 * i);
    const foot = depth > flat || torn >= 0 ? this.lastTent.subarray(2 * i, 2 * i + 2) : [0.5, 0.5];
    this.put('i_from', out, corners.slice(0, 3));
    this.put('i_to', out, corners.slice(3, 6));
    this.put('j_from', out, corners.slice(6, 9));
    this.put('j_to', out, corners.slice(9, 12));
    const wear = Math.max(0, Math.min(1, whole < 0 ? 1 : whole));
    this.put('state', out, [wear * Math.max(0, first), wear * Math.max(0, second), ...ages]);
    this.put('slack', out, [this.sag(line, i, 0), this.sag(line, i, 1), (i * 0.6180339887) % 1]);
    this.put('rise', out, rise);
    this.put('tent', out, [foot[0]!, foot[1]!, torn, depth]);
    return true;
  }

  /** What hangs through of a fibre that is shorter than at the start, m. */
  private sag(line: Float32Array, i: number, fibre: number): number {
    return Math.sqrt(Math.max(0, this.restLength[2 * i + fibre]! ** 2 - length(line, fibre) ** 2)) * 0.38;
  }

  private allocate(count: number): void {
    this.count = count;
    this.restLength = new Float32Array(2 * count);
    this.lastTent = new Float32Array(2 * count).fill(0.5);
    this.parting = new Parting(3 * count);
    this.geometry.dispose();
    for (const [name, size] of Object.entries(sizes)) {
      const a = new THREE.InstancedBufferAttribute(new Float32Array(count * size), size);
      this.attributes.set(name, a.setUsage(THREE.DynamicDrawUsage));
      this.geometry.setAttribute(name, a);
    }
    this.geometry.instanceCount = 0;
  }

  private put(name: keyof typeof sizes, at: number, numbers: ArrayLike<number>): void {
    const a = this.attributes.get(name)!;
    a.array.set(numbers, at * a.itemSize);
  }

  /** Two halves that part in the middle: position = (across, along, half). */
  private buildGrid(): void {
    const position: number[] = [];
    const index: number[] = [];
    for (const half of [0, 1])
      for (let t = 0; t <= alongStepsPerHalf; t++)
        for (let s = 0; s <= acrossSteps; s++) {
          const here = position.length / 3;
          position.push(s / acrossSteps, 0.5 * (half + t / alongStepsPerHalf), half);
          if (t === alongStepsPerHalf || s === acrossSteps) continue;
          const above = here + acrossSteps + 1;
          index.push(here, here + 1, above, here + 1, above + 1, above);
        }
    this.geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
    this.geometry.setIndex(index);
  }
}

/** Of the first (0) or the second fibre (1) of a line's piece, m. */
function length(line: Float32Array, fibre: number): number {
  const a = 4 + 8 * fibre;
  return Math.hypot(line[a]! - line[a + 4]!, line[a + 1]! - line[a + 5]!, line[a + 2]! - line[a + 6]!);
}
