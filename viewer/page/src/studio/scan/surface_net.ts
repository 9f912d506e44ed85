// SPDX-License-Identifier: GPL-3.0-or-later
// The border of what is positive on a grid, as one vertex in each cell that it crosses (S. F. Gibson, "Constrained
// elastic surface nets", 1998). Outside of the grid all is negative, so the surface is closed.

export interface Net {
  /** Positions in nodes of the grid. */
  positions: Float32Array;
  triangles: Uint32Array;
}

const corners = [0, 1, 2, 3, 4, 5, 6, 7] as const;
/** Pairs of corners, one after the other; bits: x, y, z. */
const edges = Uint8Array.from(
  corners.flatMap((c) => [1, 2, 4].filter((bit) => (c & bit) === 0).flatMap((bit) => [c, c | bit])),
);

class Growing {
  positions = new Float32Array(3 * 4096);
  triangles = new Uint32Array(6 * 4096);
  points = 0;
  corners = 0;

  point(x: number, y: number, z: number): number {
    if (3 * this.points + 3 > this.positions.length) this.positions = Growing.twice(this.positions);
    const n = 3 * this.points;
    [this.positions[n], this.positions[n + 1], this.positions[n + 2]] = [x, y, z];
    return this.points++;
  }
  /** Four points around an edge, turned so that the triangles face outward. */
  quad(a: number, b: number, c: number, d: number, turned: boolean): void {
    if (this.corners + 6 > this.triangles.length) this.triangles = Growing.twice(this.triangles);
    this.triangle(a, turned ? b : d, c);
    this.triangle(a, c, turned ? d : b);
  }
  private triangle(a: number, b: number, c: number): void {
    const n = this.corners;
    [this.triangles[n], this.triangles[n + 1], this.triangles[n + 2]] = [a, b, c];
    this.corners += 3;
  }
  private static twice<T extends Float32Array | Uint32Array>(old: T): T {
    const out = new (old.constructor as new (n: number) => T)(2 * old.length);
    out.set(old);
    return out;
  }
}

/** The grid with one more node on each side, which is outside. */
class Padded {
  readonly across: readonly [number, number, number];
  readonly values: Float32Array;
  private readonly offsets: readonly number[];
  private readonly corner = new Float64Array(8);
  private readonly mean = new Float64Array(3);

  constructor(
    readonly size: readonly [number, number, number],
    given: Float32Array,
  ) {
    const [nx, ny, nz] = size;
    this.across = [1, nx + 2, (nx + 2) * (ny + 2)];
    this.offsets = corners.map((c) => this.index(c & 1, (c >> 1) & 1, c >> 2));
    this.values = new Float32Array((nx + 2) * (ny + 2) * (nz + 2)).fill(-1);
    for (let k = 0; k < nz; k++)
      for (let j = 0; j < ny; j++) {
        const from = nx * (j + ny * k);
        this.values.set(given.subarray(from, from + nx), this.index(1, j + 1, k + 1));
      }
  }
  index(i: number, j: number, k: number): number {
    return i + this.across[1] * j + this.across[2] * k;
  }
  /** Of the cell at node n: the mean of where the border crosses its edges. It holds until the next call. */
  crossing(n: number): Float64Array {
    const { values, offsets, corner, mean } = this;
    for (let c = 0; c < 8; c++) corner[c] = values[n + offsets[c]!]!;
    let [x, y, z, count] = [0, 0, 0, 0];
    for (let e = 0; e < edges.length; e += 2) {
      const [a, b] = [edges[e]!, edges[e + 1]!];
      const [va, vb] = [corner[a]!, corner[b]!];
      if (va > 0 === vb > 0) continue;
      const t = va / (va - vb);
      const bit = a ^ b;
      x += bit === 1 ? t : a & 1;
      y += bit === 2 ? t : (a >> 1) & 1;
      z += bit === 4 ? t : a >> 2;
      count++;
    }
    [mean[0], mean[1], mean[2]] = [x / count, y / count, z / count];
    return mean;
  }
}

/** Which of the four nodes at (i, j..j+1, k..k+1) are inside, as bits. */
function side(grid: Padded, n: number): number {
  const [, y, z] = grid.across;
  const v = grid.values;
  return (v[n]! > 0 ? 1 : 0) | (v[n + y]! > 0 ? 2 : 0) | (v[n + z]! > 0 ? 4 : 0) | (v[n + y + z]! > 0 ? 8 : 0);
}

export function surfaceNet(size: readonly [number, number, number], values: Float32Array): Net {
  const grid = new Padded(size, values);
  const [nx, ny, nz] = size;
  const out = new Growing();
  const width = nx + 1;
  // Points of the cells of two layers. Cells begin at the nodes that were added in front.
  let [below, here] = [new Int32Array(width * (ny + 1)), new Int32Array(width * (ny + 1))];
  for (let k = 0; k <= nz; k++) {
    [below, here] = [here, below];
    for (let j = 0; j <= ny; j++) {
      const row = grid.index(0, j, k);
      let left = side(grid, row);
      for (let i = 0; i <= nx; i++) {
        const right = side(grid, row + i + 1);
        const even = left === right && (left === 0 || left === 15);
        if (!even) {
          const at = grid.crossing(row + i);
          const c = i + width * j;
          here[c] = out.point(i + at[0]! - 1, j + at[1]! - 1, k + at[2]! - 1);
          const inside = (left & 1) === 1;
          // Edges that begin at the cell's first corner have all four cells behind them.
          if (inside !== ((right & 1) === 1)) out.quad(here[c], here[c - width]!, below[c - width]!, below[c]!, inside);
          if (inside !== ((left & 2) === 2)) out.quad(here[c], below[c]!, below[c - 1]!, here[c - 1]!, inside);
          if (inside !== ((left & 4) === 4))
            out.quad(here[c], here[c - 1]!, here[c - 1 - width]!, here[c - width]!, inside);
        }
        left = right;
      }
    }
  }
  return { positions: out.positions.slice(0, 3 * out.points), triangles: out.triangles.slice(0, out.corners) };
}
