// SPDX-License-Identifier: GPL-3.0-or-later
// Polylines of the style "fibre": each a small bundle of tapered fibres that fans out at its attachments, waves when
// slack, straightens and reddens when drawn out, thins as its value falls from 1 to 0, and recoils when it is below 0
// (parted). Fine cross filaments tie neighbours into a web.
import * as THREE from 'three';
import { makeRandom } from '../random';
import type { DrawableContext, Drawn, Moment } from './drawn';
import { fadeS, fibreMaterial } from './fibre_material';

const fibresPerLine = 2;
const ringsPerHalf = 9;
const sides = 5;
const wholeMark = Infinity;
/** As fibres of the body begin: drawn out by so much they are straight, and then tighten by so many newtons a metre. */
const straightAt = 1.1;
const tightening = 6;

interface Fibre {
  /** Line at each end and where along it the end sits; a line's own fibre goes from 0 to 1 of the same line. */
  a: number;
  b: number;
  ta: number;
  tb: number;
  radius: number;
}

export class Fibres implements Drawn {
  readonly root = new THREE.Group();
  private readonly bundle: THREE.Mesh;
  private readonly geometry = new THREE.InstancedBufferGeometry();
  private readonly radiusM: number;
  private fibres: Fibre[] = [];
  /** Lines that there is room for. */
  private count = 0;
  private endsA = dynamic(0, 3);
  private endsB = dynamic(0, 3);
  private state = dynamic(0, 4);
  private slack = dynamic(0, 2);
  private ends = new Float32Array(0);
  private whole = new Float32Array(0);
  private restLength = new Float32Array(0);
  private partedAt = new Float64Array(0);
  private webbed = false;

  constructor(context: DrawableContext) {
    this.radiusM = context.declared.radiusM;
    this.buildTube();
    this.allocate(context.declared.count);
    this.bundle = new THREE.Mesh(this.geometry, fibreMaterial(context.field, context.material));
    this.bundle.frustumCulled = false;
    this.bundle.receiveShadow = true;
    this.bundle.renderOrder = 2;
    this.root.add(this.bundle);
  }

  update(data: Float32Array, { seconds }: Moment): void {
    const n = data.length / 8;
    if (n > this.count) this.allocate(n);
    for (let i = 0; i < n; i++) this.take(i, data, seconds);
    if (!this.webbed && n > 0) {
      this.webbed = true;
      this.weave(n);
    }
    let out = 0;
    this.fibres.forEach((f, index) => {
      if (f.a >= n || f.b >= n) return;
      const severed = Math.max(this.age(f.a, seconds), this.age(f.b, seconds));
      if (severed <= fadeS) this.write(f, index, severed, out++);
    });
    this.geometry.instanceCount = out;
    for (const a of [this.endsA, this.endsB, this.state, this.slack]) a.needsUpdate = true;
  }

  /** The line's two ends and its value. */
  private take(i: number, data: Float32Array, seconds: number): void {
    const at = 8 * i;
    const whole = data[at + 3]!;
    // A parted line keeps the last ends known when the engine no longer sends any.
    let any = false;
    for (const k of [0, 1, 2, 4, 5, 6]) any ||= Number.isFinite(data[at + k]!) && data[at + k] !== 0;
    if (any)
      for (let k = 0; k < 3; k++) {
        this.ends[i * 6 + k] = data[at + k]!;
        this.ends[i * 6 + 3 + k] = data[at + 4 + k]!;
      }
    if (whole >= 0) this.partedAt[i] = wholeMark;
    // Already parted when this page came: nothing to animate.
    else if (this.partedAt[i] === wholeMark)
      this.partedAt[i] = this.whole[i]! >= 0 && this.webbed ? seconds : seconds - 1e6;
    this.whole[i] = whole;
    if (this.restLength[i] === 0 && any) this.restLength[i] = this.length(i);
  }

  private write(f: Fibre, index: number, severed: number, out: number): void {
    const own = f.a === f.b;
    for (let k = 0; k < 3; k++) {
      this.endsA.array[out * 3 + k] = this.along(f.a, f.ta, k);
      this.endsB.array[out * 3 + k] = this.along(f.b, f.tb, k);
    }
    const rest = this.restLength[f.a]!;
    const now = this.length(f.a);
    const tension = own && severed < 0 ? Math.max(0, now - straightAt * rest) * tightening : 0;
    const whole = Math.max(0, Math.min(this.whole[f.a]!, this.whole[f.b]!));
    const loose = own ? this.sag(f.a) : 0.0002;
    this.state.array.set([f.radius, whole, tension, severed], out * 4);
    this.slack.array.set([loose, (index * 0.6180339887) % 1], out * 2);
  }

  private allocate(count: number): void {
    this.count = count;
    this.ends = new Float32Array(count * 6);
    this.whole = new Float32Array(count);
    this.restLength = new Float32Array(count);
    this.partedAt = new Float64Array(count).fill(wholeMark);
    this.webbed = false;
    this.fibres = [];
    const random = makeRandom(101);
    for (let i = 0; i < count; i++)
      for (let k = 0; k < fibresPerLine; k++)
        this.fibres.push({
          a: i,
          b: i,
          ta: 0,
          tb: 1,
          radius: this.radiusM * (k === 0 ? 0.5 : 0.2 + 0.16 * random()),
        });
    // A web has one filament a line at most.
    const capacity = count * (fibresPerLine + 1);
    this.geometry.dispose();
    this.geometry.setAttribute('end_a', (this.endsA = dynamic(capacity, 3)));
    this.geometry.setAttribute('end_b', (this.endsB = dynamic(capacity, 3)));
    this.geometry.setAttribute('state', (this.state = dynamic(capacity, 4)));
    this.geometry.setAttribute('slack', (this.slack = dynamic(capacity, 2)));
    this.geometry.instanceCount = 0;
  }

  dispose(): void {
    this.root.removeFromParent();
    this.geometry.dispose();
    (this.bundle.material as THREE.Material).dispose();
  }

  private age(i: number, time: number): number {
    return this.whole[i]! >= 0 ? -1 : time - this.partedAt[i]!;
  }

  /** What hangs through of a line that is shorter than at the start, m. */
  private sag(i: number): number {
    const now = this.length(i);
    return Math.sqrt(Math.max(0, this.restLength[i]! ** 2 - now * now)) * 0.38;
  }

  private along(i: number, t: number, k: number): number {
    return this.ends[i * 6 + k]! * (1 - t) + this.ends[i * 6 + 3 + k]! * t;
  }

  private length(i: number): number {
    const e = this.ends;
    return Math.hypot(e[i * 6]! - e[i * 6 + 3]!, e[i * 6 + 1]! - e[i * 6 + 4]!, e[i * 6 + 2]! - e[i * 6 + 5]!);
  }

  /** Cross filaments to the nearest neighbour. */
  private weave(n: number): void {
    const random = makeRandom(55);
    for (let i = 0; i < n; i++) {
      if (this.whole[i]! < 0) continue;
      const near: { j: number; d: number }[] = [];
      for (let j = 0; j < n; j++) {
        if (j === i || this.whole[j]! < 0) continue;
        const d = Math.hypot(...[0, 1, 2].map((k) => this.along(i, 0.5, k) - this.along(j, 0.5, k)));
        if (d < 0.0045) near.push({ j, d });
      }
      near.sort((a, b) => a.d - b.d);
      for (const { j } of near.slice(0, 1)) {
        if (j < i && random() < 0.5) continue;
        this.fibres.push({
          a: i,
          b: j,
          ta: 0.15 + 0.7 * random(),
          tb: 0.15 + 0.7 * random(),
          radius: this.radiusM * 0.14,
        });
      }
    }
  }

  /** A unit tube in two halves: position = (along, cos, sin). */
  private buildTube(): void {
    const position: number[] = [];
    const index: number[] = [];
    for (let half = 0; half < 2; half++)
      for (let r = 0; r < ringsPerHalf; r++) {
        const t = half * 0.5 + (r / (ringsPerHalf - 1)) * 0.5;
        for (let k = 0; k < sides; k++) {
          const angle = (k / sides) * 2 * Math.PI;
          // t of the second half is stored with 2 added, so that the shader can tell the halves apart in the middle.
          position.push(half ? t + 2 : t, Math.cos(angle), Math.sin(angle));
          if (r + 1 < ringsPerHalf) {
            const a = (half * ringsPerHalf + r) * sides + k;
            const b = (half * ringsPerHalf + r) * sides + ((k + 1) % sides);
            index.push(a, b, a + sides, b, b + sides, a + sides);
          }
        }
      }
    this.geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
    this.geometry.setIndex(index);
  }
}

function dynamic(count: number, size: number): THREE.InstancedBufferAttribute {
  return new THREE.InstancedBufferAttribute(new Float32Array(count * size), size).setUsage(THREE.DynamicDrawUsage);
}
