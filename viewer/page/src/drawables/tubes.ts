// SPDX-License-Identifier: GPL-3.0-or-later
// Points as small balls and polylines as tubes, coloured by their value where its range is declared.
import * as THREE from 'three';
import type { DrawableContext, Drawn } from './drawn';
import { lookOf, moving } from './look';

const sides = 8;
const hot = new THREE.Color(0.9, 0.12, 0.06);

/** 0..1 of a value between the declared ends; 0 without them. */
function valueShare(c: DrawableContext, value: number): number {
  const { min, max } = c.declared.value;
  if (min === null || max === null || !(max > min) || !Number.isFinite(value)) return 0;
  return Math.max(0, Math.min(1, (value - min) / (max - min)));
}

/** Tint from the material's own colour (white) to a warm red. */
function tint(c: DrawableContext, value: number, out: THREE.Color): THREE.Color {
  return out.setRGB(1, 1, 1).lerp(hot, valueShare(c, value));
}

export class Points implements Drawn {
  readonly root = new THREE.Group();
  private readonly ball: THREE.IcosahedronGeometry;
  private readonly material: THREE.MeshPhysicalMaterial;
  private mesh: THREE.InstancedMesh | null = null;

  constructor(private readonly context: DrawableContext) {
    this.ball = new THREE.IcosahedronGeometry(context.declared.radiusM, 2);
    this.material = lookOf(context);
  }

  update(data: Float32Array): void {
    const n = data.length / 4;
    if (!this.mesh || this.mesh.instanceMatrix.count < n) this.allocate(n);
    const mesh = this.mesh!;
    const at = new THREE.Matrix4();
    const colour = new THREE.Color();
    for (let i = 0; i < n; i++) {
      mesh.setMatrixAt(i, at.setPosition(data[4 * i]!, data[4 * i + 1]!, data[4 * i + 2]!));
      mesh.setColorAt(i, tint(this.context, data[4 * i + 3]!, colour));
    }
    mesh.count = n;
    mesh.instanceMatrix.needsUpdate = true;
    if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
  }

  dispose(): void {
    this.root.removeFromParent();
    this.mesh?.dispose();
    this.ball.dispose();
    this.material.dispose();
  }

  private allocate(n: number): void {
    this.mesh?.removeFromParent();
    this.mesh?.dispose();
    this.mesh = moving(new THREE.InstancedMesh(this.ball, this.material, Math.max(1, n)));
    this.root.add(this.mesh);
  }
}

/** Curves of vessels are smooth: so many pieces between two points. */
const pieces = 4;

/**
 * Lines of `each` points on smooth curves through them (Catmull and Rom), four numbers a point as in frames; values are
 * those of the point before.
 */
export function smoothLines(data: Float32Array, each: number): Float32Array {
  const fine = (each - 1) * pieces + 1;
  const lines = data.length / (4 * each);
  const out = new Float32Array(4 * fine * lines);
  for (let l = 0; l < lines; l++)
    for (let q = 0; q < fine; q++) {
      const p = Math.min(each - 2, Math.floor(q / pieces));
      const t = q / pieces - p;
      const at = (k: number, j: number) => data[4 * (l * each + Math.max(0, Math.min(each - 1, p + k))) + j]!;
      for (let j = 0; j < 3; j++) {
        const [a, b, c, d] = [at(-1, j), at(0, j), at(1, j), at(2, j)];
        out[4 * (l * fine + q) + j] =
          b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
      }
      out[4 * (l * fine + q) + 3] = at(0, 3);
    }
  return out;
}

/** Lines with a value below 0 are gone. Those of the style "wall" are smooth and thin out at their first point. */
export class Polylines implements Drawn {
  readonly root: THREE.Mesh;
  private readonly geometry = new THREE.BufferGeometry();
  private readonly material: THREE.MeshPhysicalMaterial;
  private lines = -1;

  constructor(private readonly context: DrawableContext) {
    this.material = lookOf(context);
    this.material.vertexColors = true;
    this.root = moving(new THREE.Mesh(this.geometry, this.material));
  }

  update(given: Float32Array): void {
    const points = this.context.declared.pointsPerLine;
    const vessel = this.context.material.style === 'wall' && points > 2;
    const data = vessel ? smoothLines(given, points) : given;
    const each = vessel ? (points - 1) * pieces + 1 : points;
    const lines = data.length / (4 * each);
    if (lines !== this.lines) this.allocate(lines, each);
    const position = this.geometry.attributes.position!;
    const normal = this.geometry.attributes.normal!;
    const colour = this.geometry.attributes.color!;
    const shade = new THREE.Color();
    const rings = new Rings();
    for (let l = 0; l < lines; l++) {
      const gone = data[4 * l * each + 3]! < 0;
      rings.begin();
      for (let p = 0; p < each; p++) {
        const at = l * each + p;
        rings.turn(data, l * each, p, each);
        tint(this.context, data[4 * at + 3]!, shade);
        const thin = vessel ? Math.min(1, 0.25 + (1.5 * p) / each) : 1;
        const radius = gone ? 0 : thin * this.context.declared.radiusM;
        for (let s = 0; s < sides; s++) {
          const v = at * sides + s;
          const m = rings.direction(s);
          // A line that is gone collapses to nothing.
          position.setXYZ(v, ...(gone ? zero : rings.place(m, radius)));
          normal.setXYZ(v, m.x, m.y, m.z);
          colour.setXYZ(v, shade.r, shade.g, shade.b);
        }
      }
    }
    for (const a of [position, normal, colour]) a.needsUpdate = true;
  }

  dispose(): void {
    this.root.removeFromParent();
    this.geometry.dispose();
    this.material.dispose();
  }

  private allocate(lines: number, each: number): void {
    this.lines = lines;
    this.geometry.dispose();
    const n = lines * each * sides;
    for (const name of ['position', 'normal', 'color'])
      this.geometry.setAttribute(
        name,
        new THREE.BufferAttribute(new Float32Array(3 * n), 3).setUsage(THREE.DynamicDrawUsage),
      );
    this.geometry.setIndex(tubeIndices(lines, each));
  }
}

const zero: [number, number, number] = [0, 0, 0];

/** Triangles between the rings of each line. */
export function tubeIndices(lines: number, each: number): number[] {
  const out: number[] = [];
  for (let l = 0; l < lines; l++)
    for (let p = 0; p + 1 < each; p++)
      for (let s = 0; s < sides; s++) {
        const a = (l * each + p) * sides + s;
        const b = (l * each + p) * sides + ((s + 1) % sides);
        out.push(a, b, a + sides, b, b + sides, a + sides);
      }
  return out;
}

/** The frame of a tube along a line, carried from point to point so that it does not twist. */
class Rings {
  private readonly centre = new THREE.Vector3();
  private readonly run = new THREE.Vector3();
  private readonly across = new THREE.Vector3();
  private readonly third = new THREE.Vector3();
  private started = false;

  begin(): void {
    this.started = false;
  }

  /** Goes to point `p` of the line that begins at point `first`. */
  turn(data: Float32Array, first: number, p: number, each: number): void {
    const point = (k: number, out: THREE.Vector3) => out.fromArray(data, 4 * (first + k));
    point(Math.min(each - 1, p + 1), this.run).sub(point(Math.max(0, p - 1), this.third));
    if (this.run.lengthSq() < 1e-18) this.run.set(0, 0, 1);
    this.run.normalize();
    point(p, this.centre);
    if (!this.started) this.across.set(Math.abs(this.run.x) < 0.7 ? 1 : 0, Math.abs(this.run.x) < 0.7 ? 0 : 1, 0);
    this.started = true;
    this.across.addScaledVector(this.run, -this.across.dot(this.run));
    if (this.across.lengthSq() < 1e-9) this.across.set(this.run.y, this.run.z, this.run.x).cross(this.run);
    this.across.normalize();
    this.third.crossVectors(this.run, this.across);
  }

  direction(s: number): THREE.Vector3 {
    const angle = (s / sides) * 2 * Math.PI;
    return this.across.clone().multiplyScalar(Math.cos(angle)).addScaledVector(this.third, Math.sin(angle));
  }

  place(direction: THREE.Vector3, radius: number): [number, number, number] {
    return [
      this.centre.x + radius * direction.x,
      this.centre.y + radius * direction.y,
      this.centre.z + radius * direction.z,
    ];
  }
}
