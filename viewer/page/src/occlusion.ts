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
const curvatureReachM = 0.004;

export function bakeShading(tissues: Tissue[]): Shading[] {
  const count = tissues.reduce((n, t) => n + t.positions.length / 3, 0);
  const p = new Float32Array(count * 3);
  const n = new Float32Array(count * 3);
  const area = new Float32Array(count);
  const owner = new Uint8Array(count);
  let at = 0;
  tissues.forEach((t, k) => {
    p.set(t.positions, at * 3);
    n.set(t.normals, at * 3);
    vertexAreas(t, area, at);
    owner.fill(k, at, at + t.positions.length / 3);
    at += t.positions.length / 3;
  });
  const grid = new PointGrid(p, reachM / 2);
  const out: Shading[] = [];
  at = 0;
  for (let k = 0; k < tissues.length; k++) {
    const m = tissues[k]!.positions.length / 3;
    const openness = new Float32Array(m);
    const convexity = new Float32Array(m);
    for (let i = 0; i < m; i++) {
      const v = (at + i) * 3;
      const nx = n[v]!;
      const ny = n[v + 1]!;
      const nz = n[v + 2]!;
      let shut = 0;
      let bend = 0;
      let weight = 0;
      grid.near(p[v]!, p[v + 1]!, p[v + 2]!, reachM, (j, d2) => {
        if (d2 < 1e-12) return;
        const d = Math.sqrt(d2);
        const o = j * 3;
        const dx = (p[o]! - p[v]!) / d;
        const dy = (p[o + 1]! - p[v + 1]!) / d;
        const dz = (p[o + 2]! - p[v + 2]!) / d;
        const up = nx * dx + ny * dy + nz * dz;
        const facing = -(n[o]! * dx + n[o + 1]! * dy + n[o + 2]! * dz);
        if (up > 0.02 && facing > 0) {
          const fade = 1 - d / reachM;
          shut += (area[j]! * up * facing * fade) / (Math.PI * d2 + area[j]!);
        }
        if (d < curvatureReachM && owner[j] === k) {
          bend -= up * area[j]!;
          weight += area[j]!;
        }
      });
      openness[i] = 1 / (1 + 2.6 * shut);
      convexity[i] = weight > 0 ? Math.max(-1, Math.min(1, (bend / weight) * 3.2)) : 0;
    }
    smooth(tissues[k]!.indices, openness, 1);
    smooth(tissues[k]!.indices, convexity, 2);
    out.push({ openness, convexity });
    at += m;
  }
  return out;
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
