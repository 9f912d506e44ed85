// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid surfaces, to ask which of them lies at a place: bone that stands still, and tools where they are.
import * as THREE from 'three';
import type { HingeData, MeshData, ToolData } from '../bundle_types';
import type { RenderFrame } from '../lcm';
import { linkPose } from '../link_pose';

export type ToolFrame = Pick<RenderFrame['tool'][number], 'index' | 'hand' | 'state' | 'p_m' | 'q' | 'opening_rad'>;

/** Triangles with a box about each, so that most are passed over at once. */
export class Solid {
  private readonly boxes: Float32Array;
  private readonly whole = new THREE.Box3();
  private readonly triangle = new THREE.Triangle();
  private readonly closest = new THREE.Vector3();

  constructor(private readonly mesh: MeshData) {
    const { positions, indices } = mesh;
    const n = indices.length / 3;
    this.boxes = new Float32Array(6 * n);
    for (let t = 0; t < n; t++)
      for (let k = 0; k < 3; k++) {
        const a = positions[3 * indices[3 * t]! + k]!;
        const b = positions[3 * indices[3 * t + 1]! + k]!;
        const c = positions[3 * indices[3 * t + 2]! + k]!;
        this.boxes[6 * t + k] = Math.min(a, b, c);
        this.boxes[6 * t + 3 + k] = Math.max(a, b, c);
      }
    this.whole.setFromArray(positions);
  }

  /** Whether a triangle comes within `reach` metres of the point. */
  touches(point: THREE.Vector3, reach: number): boolean {
    if (this.whole.distanceToPoint(point) > reach) return false;
    const { boxes } = this;
    const { x, y, z } = point;
    for (let i = 0; i < boxes.length; i += 6) {
      if (x < boxes[i]! - reach || x > boxes[i + 3]! + reach) continue;
      if (y < boxes[i + 1]! - reach || y > boxes[i + 4]! + reach) continue;
      if (z < boxes[i + 2]! - reach || z > boxes[i + 5]! + reach) continue;
      if (this.distance(i / 6, point) <= reach) return true;
    }
    return false;
  }

  private distance(t: number, point: THREE.Vector3): number {
    const { positions, indices } = this.mesh;
    this.triangle.a.fromArray(positions, 3 * indices[3 * t]!);
    this.triangle.b.fromArray(positions, 3 * indices[3 * t + 1]!);
    this.triangle.c.fromArray(positions, 3 * indices[3 * t + 2]!);
    return this.triangle.closestPointToPoint(point, this.closest).distanceTo(point);
  }
}

/** A tool with its links; points are given in the scene frame. */
export class ToolSolid {
  readonly index: number;
  private readonly hinges: readonly HingeData[];
  private readonly parts: { link: number; solid: Solid }[];
  /** From the scene into the frame of each link, for this pose. */
  private readonly into: THREE.Matrix4[];
  private placed: ToolFrame | null = null;
  private readonly local = new THREE.Vector3();

  constructor(data: ToolData) {
    this.index = data.index;
    this.hinges = data.hinges;
    this.parts = data.parts.map((p) => ({ link: p.link, solid: new Solid(p) }));
    this.into = Array.from({ length: data.hinges.length + 1 }, () => new THREE.Matrix4());
  }

  touches(point: THREE.Vector3, at: ToolFrame, reach: number): boolean {
    if (at !== this.placed) this.place(at);
    return this.parts.some(({ link, solid }) =>
      solid.touches(this.local.copy(point).applyMatrix4(this.into[link]!), reach),
    );
  }

  private place(at: ToolFrame): void {
    this.placed = at;
    const root = new THREE.Matrix4().compose(position(at), rotation(at), new THREE.Vector3(1, 1, 1));
    this.into.forEach((into, k) => {
      linkPose(this.hinges, k, at.opening_rad, into);
      into.premultiply(root).invert();
    });
  }
}

type PoseFrame = Pick<ToolFrame, 'p_m' | 'q'>;
const position = ({ p_m: p }: PoseFrame) => new THREE.Vector3(p[0], p[1], p[2]);
/** w x y z, as in the messages. */
const rotation = ({ q }: PoseFrame) => new THREE.Quaternion(q[1], q[2], q[3], q[0]).normalize();

/** A point of the scene in the frame of a tool. */
export const inToolFrame = (point: THREE.Vector3, at: PoseFrame): THREE.Vector3 =>
  point.clone().sub(position(at)).applyQuaternion(rotation(at).invert());

/** And back. */
export const inScene = (local: THREE.Vector3, at: PoseFrame): THREE.Vector3 =>
  local.clone().applyQuaternion(rotation(at)).add(position(at));
