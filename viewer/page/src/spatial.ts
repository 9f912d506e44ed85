// SPDX-License-Identifier: GPL-3.0-or-later
// Points in a uniform grid, for neighbourhood queries at load time.

/** A finer grid than this would take more memory than it saves time. */
const mostCells = 1 << 20;

/** Cells of a box in rows along z; the points of a cell, and of a row of cells, lie one after another. */
export class PointGrid {
  private readonly low = [Infinity, Infinity, Infinity];
  private readonly cells = [1, 1, 1];
  private readonly size: number;
  /** Where each cell's points begin; one more for the end of the last. */
  private readonly start: Uint32Array;
  /** The points cell by cell: index and coordinates. */
  private readonly order: Uint32Array;
  private readonly sorted: Float32Array;

  /** points: x, y, z of each, finite. size: of a cell. */
  constructor(points: Float32Array, size: number) {
    const count = points.length / 3;
    const high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < points.length; i++) {
      this.low[i % 3] = Math.min(this.low[i % 3]!, points[i]!);
      high[i % 3] = Math.max(high[i % 3]!, points[i]!);
    }
    const extent = high.map((h, k) => Math.max(0, h - this.low[k]!));
    const cellsOf = (s: number) => extent.map((e) => Math.floor(e / s) + 1);
    const total = (s: number) => cellsOf(s).reduce((n, c) => n * c, 1);
    while (count > 0 && total(size) > mostCells) size *= 1.5;
    this.size = size;
    if (count > 0) this.cells = cellsOf(size);
    const home = new Uint32Array(count);
    this.start = new Uint32Array(this.cells[0]! * this.cells[1]! * this.cells[2]! + 1);
    for (let i = 0; i < count; i++) {
      const row = this.row(this.cell(points[3 * i]!, 0), this.cell(points[3 * i + 1]!, 1));
      home[i] = row + this.cell(points[3 * i + 2]!, 2);
      this.start[home[i]! + 1]!++;
    }
    for (let n = 1; n < this.start.length; n++) this.start[n]! += this.start[n - 1]!;
    this.order = new Uint32Array(count);
    this.sorted = new Float32Array(3 * count);
    const next = this.start.slice();
    for (let i = 0; i < count; i++) {
      const at = next[home[i]!]!++;
      this.order[at] = i;
      for (let k = 0; k < 3; k++) this.sorted[3 * at + k] = points[3 * i + k]!;
    }
  }

  /**
   * Calls visit(index, squared distance) for every point within radius (<= any; cost grows with radius / cell size).
   */
  near(x: number, y: number, z: number, radius: number, visit: (i: number, d2: number) => void): void {
    const { start, order, sorted } = this;
    const r2 = radius * radius;
    const a1 = this.cell(x + radius, 0);
    const b0 = this.cell(y - radius, 1);
    const b1 = this.cell(y + radius, 1);
    const c0 = this.cell(z - radius, 2);
    const c1 = this.cell(z + radius, 2);
    for (let a = this.cell(x - radius, 0); a <= a1; a++)
      for (let b = b0; b <= b1; b++) {
        const row = this.row(a, b);
        const end = start[row + c1 + 1]!;
        for (let n = start[row + c0]!; n < end; n++) {
          const dx = sorted[3 * n]! - x;
          const dy = sorted[3 * n + 1]! - y;
          const dz = sorted[3 * n + 2]! - z;
          const d2 = dx * dx + dy * dy + dz * dz;
          if (d2 <= r2) visit(order[n]!, d2);
        }
      }
  }

  /** -1: no point is within the radius. */
  nearest(x: number, y: number, z: number, radius: number): number {
    let best = -1;
    let bestD2 = Infinity;
    this.near(x, y, z, radius, (i, d2) => {
      if (d2 < bestD2) {
        best = i;
        bestD2 = d2;
      }
    });
    return best;
  }

  /** Of what lies outside the box, the cell at its border. */
  private cell(v: number, axis: number): number {
    const n = Math.floor((v - this.low[axis]!) / this.size);
    return Math.min(this.cells[axis]! - 1, Math.max(0, n || 0));
  }
  private row(a: number, b: number): number {
    return (a * this.cells[1]! + b) * this.cells[2]!;
  }
}
