// SPDX-License-Identifier: GPL-3.0-or-later
// Points in a uniform grid, for neighbourhood queries at load time.

export class PointGrid {
  private readonly cells = new Map<number, number[]>();

  constructor(
    private readonly points: Float32Array,
    private readonly size: number,
  ) {
    for (let i = 0; i < points.length / 3; i++) {
      const key = this.key(this.cell(points[i * 3]!), this.cell(points[i * 3 + 1]!), this.cell(points[i * 3 + 2]!));
      const list = this.cells.get(key);
      if (list) list.push(i);
      else this.cells.set(key, [i]);
    }
  }

  /**
   * Calls visit(index, squared distance) for every point within radius (<= any; cost grows with radius / cell size).
   */
  near(x: number, y: number, z: number, radius: number, visit: (i: number, d2: number) => void): void {
    const r2 = radius * radius;
    for (let a = this.cell(x - radius); a <= this.cell(x + radius); a++)
      for (let b = this.cell(y - radius); b <= this.cell(y + radius); b++)
        for (let c = this.cell(z - radius); c <= this.cell(z + radius); c++) {
          const list = this.cells.get(this.key(a, b, c));
          if (!list) continue;
          for (const i of list) {
            const dx = this.points[i * 3]! - x;
            const dy = this.points[i * 3 + 1]! - y;
            const dz = this.points[i * 3 + 2]! - z;
            const d2 = dx * dx + dy * dy + dz * dz;
            if (d2 <= r2) visit(i, d2);
          }
        }
  }

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

  private cell(v: number): number {
    return Math.floor(v / this.size);
  }
  private key(a: number, b: number, c: number): number {
    return ((a + 4096) * 8192 + (b + 4096)) * 8192 + (c + 4096);
  }
}
