// SPDX-License-Identifier: GPL-3.0-or-later
// What of a scan is vessel, on the nodes of a coarser grid: the connected part that the case builder would keep
// (tools/case_builder/grid_surface.cpp).
import type { Vec } from './block';
import type { SampledScan } from './sampled_scan';

/** What the author has chosen, in voxels of the block and in stored values. */
export interface Wanted {
  /** Vessel from here up. */
  threshold: number;
  /** In place of the threshold. */
  label: number | null;
  seed: Vec | null;
  from: Vec;
  to: Vec;
  /** In voxels, radii in mm. */
  strokes: { erase: boolean; radius: number; points: Vec[] }[];
  /** Sides of a voxel, mm. */
  spacing: Vec;
}

export const mostNodes = 144;

export interface VesselGrid {
  size: Vec;
  /** Voxels a node. */
  step: number;
  /** Of the voxel of the first node. */
  from: Vec;
  /** Above 0 in the vessel, about in [-1, 1] near its border. */
  level: Float32Array;
  /** 1: kept, 2: vessel too, but another piece. */
  part: Uint8Array;
  /** Nodes that were looked at, and those that were looked at for their neighbours. */
  work: number;
}

/** Above 0 where a node's brightest voxel is vessel. */
function compare(scan: SampledScan, w: Wanted, grid: VesselGrid): void {
  const { step, size, from, level } = grid;
  const most = scan.brightest({ from, size, step, label: w.label });
  const limit = w.label === null ? w.threshold : 0.5;
  const soft = w.label === null ? 1 / Math.max(1, Math.abs(w.threshold) / 4) : 1;
  for (let n = 0; n < level.length; n++) {
    const over = (most[n]! - limit) * soft;
    level[n] = over === 0 ? 1e-6 : over > 1 ? 1 : over < -1 ? -1 : over;
  }
}

/** Sets or clears what lies within a stroke's radius of the line between two of its points. */
function paintLine(grid: VesselGrid, w: Wanted, stroke: Wanted['strokes'][number], ends: readonly [Vec, Vec]): void {
  const inner = (grid.step - 1) / 2;
  const node = (p: Vec) => p.map((x, a) => (x - grid.from[a]! - inner) / grid.step) as Vec;
  const mm = w.spacing.map((s) => s * grid.step) as Vec;
  const [a, b] = [node(ends[0]), node(ends[1])];
  const along = b.map((x, k) => (x - a[k]!) * mm[k]!) as Vec;
  const length2 = along[0] ** 2 + along[1] ** 2 + along[2] ** 2;
  const range = [0, 1, 2].map((k) => {
    const half = stroke.radius / mm[k]! + 1;
    const from = Math.max(0, Math.ceil(Math.min(a[k]!, b[k]!) - half));
    return [from, Math.min(grid.size[k]! - 1, Math.floor(Math.max(a[k]!, b[k]!) + half))] as const;
  });
  const [ri, rj, rk] = range as [readonly [number, number], readonly [number, number], readonly [number, number]];
  const soft = Math.min(...mm);
  for (let k = rk[0]; k <= rk[1]; k++)
    for (let j = rj[0]; j <= rj[1]; j++)
      for (let i = ri[0]; i <= ri[1]; i++) {
        const p = [(i - a[0]) * mm[0], (j - a[1]) * mm[1], (k - a[2]) * mm[2]] as const;
        const dot = p[0] * along[0] + p[1] * along[1] + p[2] * along[2];
        const t = length2 > 0 ? Math.min(1, Math.max(0, dot / length2)) : 0;
        const away = Math.hypot(p[0] - t * along[0], p[1] - t * along[1], p[2] - t * along[2]);
        const inside = Math.min(1, Math.max(-1, (stroke.radius - away) / soft));
        const n = i + grid.size[0] * (j + grid.size[1] * k);
        grid.level[n] = stroke.erase ? Math.min(grid.level[n]!, -inside) : Math.max(grid.level[n]!, inside);
      }
}

function paint(grid: VesselGrid, w: Wanted): void {
  for (const stroke of w.strokes)
    stroke.points.forEach((p, k) => paintLine(grid, w, stroke, [stroke.points[Math.max(0, k - 1)]!, p]));
}

/** Marks the nodes connected with `start`. Returns how many. */
function flood(grid: VesselGrid, start: number, mark: number, list: Int32Array): number {
  const { part, level } = grid;
  const [nx, ny, nz] = grid.size;
  const across = [1, nx, nx * ny] as const;
  let count = 1;
  list[0] = start;
  part[start] = mark;
  const visit = (to: number) => {
    if (part[to] !== 0 || level[to]! <= 0) return;
    part[to] = mark;
    list[count++] = to;
  };
  for (let at = 0; at < count; at++) {
    const n = list[at]!;
    const [i, j, k] = [n % nx, Math.floor(n / nx) % ny, Math.floor(n / (nx * ny))];
    if (i > 0) visit(n - 1);
    if (i + 1 < nx) visit(n + 1);
    if (j > 0) visit(n - across[1]);
    if (j + 1 < ny) visit(n + across[1]);
    if (k > 0) visit(n - across[2]);
    if (k + 1 < nz) visit(n + across[2]);
  }
  grid.work += count;
  return count;
}

/** The vessel's node nearest to the seed; -1: there is none. */
function nearest(grid: VesselGrid, seed: Vec): number {
  const at = seed.map((x, a) => (x - grid.from[a]!) / grid.step - 0.5 + 0.5 / grid.step);
  let [best, least, n] = [-1, Infinity, 0];
  for (let k = 0; k < grid.size[2]; k++)
    for (let j = 0; j < grid.size[1]; j++)
      for (let i = 0; i < grid.size[0]; i++, n++) {
        if (grid.level[n]! <= 0) continue;
        const away = (i - at[0]!) ** 2 + (j - at[1]!) ** 2 + (k - at[2]!) ** 2;
        if (away < least) [best, least] = [n, away];
      }
  return best;
}

/** Keeps the piece at the seed, else the largest. Others are marked with 2. */
function keepOne(grid: VesselGrid, seed: Vec | null): void {
  const list = new Int32Array(grid.level.length);
  const { level, part } = grid;
  const kept = 1;
  if (seed) {
    const start = nearest(grid, seed);
    if (start >= 0) flood(grid, start, kept, list);
  } else {
    let [largest, most] = [-1, 0];
    for (let n = 0; n < level.length; n++) {
      if (part[n] !== 0 || level[n]! <= 0) continue;
      const count = flood(grid, n, 3, list);
      if (count > most) [largest, most] = [n, count];
    }
    for (let n = 0; n < part.length; n++) if (part[n] === 3) part[n] = 0;
    if (largest >= 0) flood(grid, largest, kept, list);
  }
  for (let n = 0; n < level.length; n++)
    if (level[n]! > 0 && part[n] === 0) {
      part[n] = 2;
      level[n] = -level[n]!;
    }
}

export function vesselGrid(scan: SampledScan, wanted: Wanted): VesselGrid {
  const span = wanted.to.map((x, a) => x - wanted.from[a]! + 1);
  const step = Math.max(1, Math.ceil(Math.max(...span) / mostNodes));
  const nodes = span.map((n) => Math.max(1, Math.floor(n / step))) as Vec;
  const count = nodes[0] * nodes[1] * nodes[2];
  const grid: VesselGrid = {
    size: nodes,
    step,
    from: wanted.from,
    level: new Float32Array(count),
    part: new Uint8Array(count),
    work: count,
  };
  compare(scan, wanted, grid);
  paint(grid, wanted);
  keepOne(grid, wanted.seed);
  return grid;
}
