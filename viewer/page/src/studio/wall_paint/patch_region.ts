// SPDX-License-Identifier: GPL-3.0-or-later
// Which vertices of a surface are of a painted part. A spot begins at the vertex nearest to its point and grows along
// edges as far as its radius, as the wall's membrane does it with triangles (plugins/membrane/wall_topology.h).
import type { Point } from '../api';
import type { WallPatch } from './patches';

type Numbers = ArrayLike<number>;

/** Neighbours of each vertex, one after the other: those of v are from start[v] to start[v + 1]. */
interface Neighbours {
  start: Uint32Array;
  next: Uint32Array;
}

function neighboursOf(count: number, triangles: Numbers): Neighbours {
  const start = new Uint32Array(count + 1);
  for (let k = 0; k < triangles.length; k++) start[triangles[k]! + 1]! += 2;
  for (let v = 0; v < count; v++) start[v + 1]! += start[v]!;
  const next = new Uint32Array(2 * triangles.length);
  const filled = start.slice();
  for (let k = 0; k < triangles.length; k++) {
    const [corner, first] = [k % 3, k - (k % 3)];
    const v = triangles[k]!;
    next[filled[v]!++] = triangles[first + ((corner + 1) % 3)]!;
    next[filled[v]!++] = triangles[first + ((corner + 2) % 3)]!;
  }
  return { start, next };
}

export class PatchRegion {
  private readonly neighbours: Neighbours;
  private readonly known = new Map<string, Uint32Array>();

  constructor(
    private readonly positions: Numbers,
    triangles: Numbers,
  ) {
    this.neighbours = neighboursOf(positions.length / 3, triangles);
  }

  /** The patch of each vertex, the last one where several lie; -1: none. */
  patchOfVertices(patches: readonly WallPatch[]): Int16Array {
    const out = new Int16Array(this.positions.length / 3).fill(-1);
    patches.forEach((patch, k) => {
      for (const point of patch.points) for (const v of this.spot(point, patch.radius_mm)) out[v] = k;
    });
    return out;
  }

  private distance(v: number, [x, y, z]: Point): number {
    const p = this.positions;
    return Math.hypot(p[3 * v]! - x, p[3 * v + 1]! - y, p[3 * v + 2]! - z);
  }

  private nearest(point: Point): number {
    let [best, least] = [0, Infinity];
    for (let v = 0; 3 * v < this.positions.length; v++) {
      const d = this.distance(v, point);
      if (d < least) [best, least] = [v, d];
    }
    return best;
  }

  private spot(point: Point, radius: number): Uint32Array {
    const key = [...point, radius].join();
    const known = this.known.get(key);
    if (known) return known;
    const found = this.grown(this.nearest(point), point, radius);
    this.known.set(key, found);
    return found;
  }

  private grown(first: number, point: Point, radius: number): Uint32Array {
    const { start, next } = this.neighbours;
    const seen = new Set([first]);
    const front = [first];
    for (let v = front.pop(); v !== undefined; v = front.pop())
      for (let k = start[v]!; k < start[v + 1]!; k++) {
        const w = next[k]!;
        if (seen.has(w) || this.distance(w, point) > radius) continue;
        seen.add(w);
        front.push(w);
      }
    return Uint32Array.from(seen);
  }
}
