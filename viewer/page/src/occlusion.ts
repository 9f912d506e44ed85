// SPDX-License-Identifier: GPL-3.0-or-later
// Shading facts of tissue baked per vertex at load: how open the surface is to light (sulci and the fissure are
// dark), and its mean curvature over a few millimetres (gyral crowns positive, sulcal floors negative). Vertices act
// as small discs (surfels), as in Bunnell's ambient occlusion, since no ray caster is needed at this size.
import { PointGrid } from './spatial';

export interface Shading {
  /** 1 open ... 0 shut in. */
  openness: Float32Array;
  /** -1 sulcal floor ... +1 crown. */
  convexity: Float32Array;
}

export interface Tissue {
  positions: Float32Array;
  normals: Float32Array;
  indices: Uint32Array;
}

const reachM = 0.008;
/** Nearer surfels count one by one; beyond, those of a cell that face the same way count as one. */
const nearM = 0.004;
const cellM = 0.002;

/** Places, unit normals and areas of small discs. */
interface Surfels {
  p: Float32Array;
  n: Float32Array;
  area: Float32Array;
}

/** Light that surfels keep away from a place: those within distances from..to of it. */
class Shade {
  private readonly grid: PointGrid;

  constructor(
    private readonly surfels: Surfels,
    private readonly fromM: number,
    private readonly toM: number,
  ) {
    this.grid = new PointGrid(surfels.p, toM / 2);
  }

  /** visit: each surfel with its height over the place's plane and its distance, m; v: of the place in p and n. */
  at(p: Float32Array, n: Float32Array, v: number, visit: (j: number, up: number, d: number) => void): number {
    const { p: q, n: m, area } = this.surfels;
    const [x, y, z] = [p[v]!, p[v + 1]!, p[v + 2]!];
    const [nx, ny, nz] = [n[v]!, n[v + 1]!, n[v + 2]!];
    const from2 = Math.max(1e-12, this.fromM * this.fromM);
    let shut = 0;
    this.grid.near(x, y, z, this.toM, (j, d2) => {
      if (d2 < from2) return;
      const d = Math.sqrt(d2);
      const o = 3 * j;
      const dx = (q[o]! - x) / d;
      const dy = (q[o + 1]! - y) / d;
      const dz = (q[o + 2]! - z) / d;
      const up = nx * dx + ny * dy + nz * dz;
      visit(j, up, d);
      if (up <= 0.02) return;
      const facing = -(m[o]! * dx + m[o + 1]! * dy + m[o + 2]! * dz);
      if (facing > 0) shut += (area[j]! * up * facing * (1 - d / reachM)) / (Math.PI * d2 + area[j]!);
    });
    return shut;
  }
}

const nothing = () => undefined;

export function bakeShading(tissues: Tissue[]): Shading[] {
  const count = tissues.reduce((n, t) => n + t.positions.length / 3, 0);
  const all: Surfels = {
    p: new Float32Array(count * 3),
    n: new Float32Array(count * 3),
    area: new Float32Array(count),
  };
  const owner = new Uint8Array(count);
  let at = 0;
  tissues.forEach((t, k) => {
    all.p.set(t.positions, at * 3);
    all.n.set(t.normals, at * 3);
    vertexAreas(t, all.area, at);
    owner.fill(k, at, at + t.positions.length / 3);
    at += t.positions.length / 3;
  });
  const near = new Shade(all, 0, nearM);
  const { groups, of } = coarsened(all);
  const far = new Shade(groups, nearM, reachM);
  // What is far darkens all of a group alike.
  const farShut = groups.area.map((_, g) => far.at(groups.p, groups.n, 3 * g, nothing));
  const out: Shading[] = [];
  at = 0;
  for (let k = 0; k < tissues.length; k++) {
    const m = tissues[k]!.positions.length / 3;
    const openness = new Float32Array(m);
    const convexity = new Float32Array(m);
    for (let i = 0; i < m; i++) {
      const v = (at + i) * 3;
      let bend = 0;
      let weight = 0;
      const shut = near.at(all.p, all.n, v, (j, up) => {
        if (owner[j] !== k) return;
        bend -= up * all.area[j]!;
        weight += all.area[j]!;
      });
      openness[i] = 1 / (1 + 2.6 * (shut + farShut[of[at + i]!]!));
      convexity[i] = weight > 0 ? Math.max(-1, Math.min(1, (bend / weight) * 3.2)) : 0;
    }
    smooth(tissues[k]!.indices, openness, 1);
    smooth(tissues[k]!.indices, convexity, 2);
    out.push({ openness, convexity });
    at += m;
  }
  return out;
}

/**
 * The surfels of each cell whose normals lie about the same axis as one: mean place and normal, all their area. of: the
 * group of each surfel.
 */
function coarsened({ p, n, area }: Surfels): { groups: Surfels; of: Uint32Array } {
  const groups = new Map<number, number>();
  const of = new Uint32Array(area.length);
  const sums: number[] = [];
  for (let i = 0; i < area.length; i++) {
    const v = 3 * i;
    const [x, y, z] = [Math.abs(n[v]!), Math.abs(n[v + 1]!), Math.abs(n[v + 2]!)];
    const axis = x > y && x > z ? 0 : y > z ? 1 : 2;
    let key = 2 * axis + (n[v + axis]! > 0 ? 1 : 0);
    for (let k = 0; k < 3; k++) key = key * 4096 + ((Math.floor(p[v + k]! / cellM) + 2048) & 4095);
    let g = groups.get(key);
    if (g === undefined) {
      groups.set(key, (g = groups.size));
      sums.push(0, 0, 0, 0, 0, 0, 0);
    }
    of[i] = g;
    const a = area[i]!;
    for (let k = 0; k < 3; k++) {
      sums[7 * g + k]! += a * p[v + k]!;
      sums[7 * g + 3 + k]! += a * n[v + k]!;
    }
    sums[7 * g + 6]! += a;
  }
  const size = groups.size;
  const out: Surfels = { p: new Float32Array(3 * size), n: new Float32Array(3 * size), area: new Float32Array(size) };
  for (let g = 0; g < size; g++) {
    const a = sums[7 * g + 6]!;
    const length = Math.hypot(sums[7 * g + 3]!, sums[7 * g + 4]!, sums[7 * g + 5]!) || 1;
    for (let k = 0; k < 3; k++) {
      out.p[3 * g + k] = a > 0 ? sums[7 * g + k]! / a : 0;
      out.n[3 * g + k] = sums[7 * g + 3 + k]! / length;
    }
    out.area[g] = a;
  }
  return { groups: out, of };
}

function vertexAreas(t: Tissue, out: Float32Array, at: number): void {
  const p = t.positions;
  for (let i = 0; i < t.indices.length; i += 3) {
    const a = t.indices[i]! * 3;
    const b = t.indices[i + 1]! * 3;
    const c = t.indices[i + 2]! * 3;
    const ux = p[b]! - p[a]!;
    const uy = p[b + 1]! - p[a + 1]!;
    const uz = p[b + 2]! - p[a + 2]!;
    const vx = p[c]! - p[a]!;
    const vy = p[c + 1]! - p[a + 1]!;
    const vz = p[c + 2]! - p[a + 2]!;
    const third = Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) / 6;
    for (let k = 0; k < 3; k++) out[at + t.indices[i + k]!] = out[at + t.indices[i + k]!]! + third;
  }
}

function smooth(indices: Uint32Array, values: Float32Array, times: number): void {
  const sum = new Float32Array(values.length);
  const count = new Float32Array(values.length);
  for (let n = 0; n < times; n++) {
    sum.set(values);
    count.fill(1);
    for (let i = 0; i < indices.length; i += 3)
      for (let k = 0; k < 3; k++) {
        const a = indices[i + k]!;
        const b = indices[i + ((k + 1) % 3)]!;
        sum[a] = sum[a]! + values[b]!;
        count[a] = count[a]! + 1;
        sum[b] = sum[b]! + values[a]!;
        count[b] = count[b]! + 1;
      }
    for (let v = 0; v < values.length; v++) values[v] = sum[v]! / count[v]!;
  }
}
