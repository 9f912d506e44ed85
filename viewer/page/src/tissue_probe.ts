// SPDX-License-Identifier: GPL-3.0-or-later
// How far a point is from the tissue as it lies now: for what shows the depth of a tool's tip. A thinned-out set of
// vertices finds the place, all vertices about it give the distance.
import * as THREE from 'three';
import type { SkinnedSurface } from './bundle_types';
import { type NodeField, skinOffsets, skinVertex } from './skinning';

/** Vertices of one cell are represented by one of them, m. */
const cellM = 0.0025;
/** A way ends this near the tissue, m. */
const hitM = 0.00005;

export interface Foot {
  /** On the tissue, scene frame, m. */
  place: THREE.Vector3;
  /** Unit normal of the tissue there. */
  normal: THREE.Vector3;
  /** From the point, m; below 0 inside the tissue. */
  distanceM: number;
}

interface Vertex {
  place: number[];
  normal: number[];
}

type Place = Pick<Foot, 'place' | 'normal'>;

/** On the tangent plane of a vertex: between vertices the tissue is nearly flat. */
function footAt(vertex: THREE.Vector3, normal: THREE.Vector3, point: THREE.Vector3): Foot {
  const distanceM = point.clone().sub(vertex).dot(normal);
  const place = point.clone().addScaledVector(normal, -distanceM);
  // Beside a sharp crest the plane goes past the tissue: then the vertex itself is the place.
  if (place.distanceTo(vertex) <= cellM) return { place, normal, distanceM };
  return { place: vertex, normal, distanceM: point.distanceTo(vertex) };
}

export class TissueProbe {
  /** Vertices of each cell; the first one stands for all. */
  private readonly cells: number[][];
  private readonly offsets: Float32Array | null;
  private readonly scratch: Vertex = { place: [0, 0, 0], normal: [0, 0, 0] };

  /** `moving`: the surface's skinning and its nodes; null: it stands still. */
  constructor(
    private readonly positions: Float32Array,
    private readonly normals: Float32Array,
    private readonly moving: { surface: SkinnedSurface; field: NodeField } | null,
  ) {
    const cells = new Map<string, number[]>();
    for (let v = 0; v < positions.length / 3; v++) {
      const key = [0, 1, 2].map((k) => Math.floor(positions[3 * v + k]! / cellM)).join();
      const cell = cells.get(key);
      if (cell) cell.push(v);
      else cells.set(key, [v]);
    }
    this.cells = [...cells.values()];
    this.offsets =
      moving && skinOffsets(moving.field.rest, positions, moving.surface.skinNodes, moving.surface.skinWeights);
  }

  /** The nearest place within `reach` metres; null: there is none. */
  nearest(point: THREE.Vector3, reach: number): Foot | null {
    const spread = 2 * cellM;
    let least = reach + spread;
    const near: { cell: number[]; d: number }[] = [];
    for (const cell of this.cells) {
      const d = this.distance(cell[0]!, point);
      if (d > least + spread) continue;
      near.push({ cell, d });
      least = Math.min(least, d);
    }
    let best = reach;
    let found = -1;
    for (const { cell, d } of near) {
      if (d > least + spread) continue;
      for (const v of cell) {
        const dv = this.distance(v, point);
        if (dv >= best) continue;
        best = dv;
        found = v;
      }
    }
    return found < 0 ? null : this.foot(found, point);
  }

  /**
   * How far it is from a point along a unit direction to the tissue, m; null: no tissue within `reach`. The way is
   * gone in steps no longer than the distance to the tissue (sphere tracing).
   */
  along(from: THREE.Vector3, direction: THREE.Vector3, reach: number): number | null {
    const near = this.beside(from, direction, reach);
    const point = new THREE.Vector3();
    for (let t = 0; t <= reach && near.length > 0;) {
      point.copy(from).addScaledVector(direction, t);
      let best = near[0]!;
      for (const v of near) if (v.place.distanceToSquared(point) < best.place.distanceToSquared(point)) best = v;
      const { distanceM } = footAt(best.place, best.normal, point);
      if (distanceM < hitM) return t;
      t += Math.max(hitM, distanceM);
    }
    return null;
  }

  /** Vertices beside the way from a point along a unit direction. */
  private beside(from: THREE.Vector3, direction: THREE.Vector3, reach: number): Place[] {
    const spread = 2 * cellM;
    const way = new THREE.Line3(from, from.clone().addScaledVector(direction, reach));
    const place = new THREE.Vector3();
    const closest = new THREE.Vector3();
    const found: Place[] = [];
    for (const cell of this.cells) {
      this.locate(cell[0]!);
      place.fromArray(this.scratch.place);
      if (way.closestPointToPoint(place, true, closest).distanceTo(place) > spread) continue;
      for (const v of cell) {
        this.locate(v);
        found.push({
          place: new THREE.Vector3().fromArray(this.scratch.place),
          normal: new THREE.Vector3().fromArray(this.scratch.normal),
        });
      }
    }
    return found;
  }

  private foot(v: number, point: THREE.Vector3): Foot {
    this.locate(v);
    const vertex = new THREE.Vector3().fromArray(this.scratch.place);
    const normal = new THREE.Vector3().fromArray(this.scratch.normal);
    return footAt(vertex, normal, point);
  }

  private distance(v: number, point: THREE.Vector3): number {
    this.locate(v);
    const [x, y, z] = this.scratch.place;
    return Math.hypot(x! - point.x, y! - point.y, z! - point.z);
  }

  private locate(v: number): void {
    const { place, normal } = this.scratch;
    if (this.moving) {
      const { surface, field } = this.moving;
      const n = this.normals.subarray(3 * v, 3 * v + 3);
      skinVertex(field, surface.skinNodes, surface.skinWeights, v, n, place, normal, this.offsets);
      return;
    }
    for (let k = 0; k < 3; k++) {
      place[k] = this.positions[3 * v + k]!;
      normal[k] = this.normals[3 * v + k]!;
    }
  }
}
