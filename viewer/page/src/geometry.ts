// SPDX-License-Identifier: GPL-3.0-or-later
// Normals for meshes that come without them: smooth ones for tissue, creased ones for instruments and bone.

/** Area-weighted vertex normals; vertices at the same place share theirs. */
export function smoothNormals(positions: Float32Array, indices: Uint32Array): Float32Array {
  const weld = weldMap(positions);
  const sum = new Float32Array(positions.length);
  for (let t = 0; t < indices.length; t += 3) {
    const n = faceNormal(positions, indices, t);
    for (let k = 0; k < 3; k++) {
      const o = weld[indices[t + k]!]! * 3;
      sum[o] = sum[o]! + n[0];
      sum[o + 1] = sum[o + 1]! + n[1];
      sum[o + 2] = sum[o + 2]! + n[2];
    }
  }
  const out = new Float32Array(positions.length);
  for (let v = 0; v < positions.length / 3; v++) {
    const o = weld[v]! * 3;
    const l = Math.hypot(sum[o]!, sum[o + 1]!, sum[o + 2]!) || 1;
    for (let k = 0; k < 3; k++) out[v * 3 + k] = sum[o + k]! / l;
  }
  return out;
}

/** Normals smoothed only across edges flatter than `angle`. Corners at a place with the same normal are one vertex. */
export function creased(
  positions: Float32Array,
  indices: Uint32Array,
  angle: number,
): { positions: Float32Array; normals: Float32Array; indices: Uint32Array } {
  const weld = weldMap(positions);
  const faces = indices.length / 3;
  const normal = new Float32Array(faces * 3);
  const unit = new Float32Array(faces * 3);
  const first = new Int32Array(positions.length / 3).fill(-1);
  const next = new Int32Array(indices.length).fill(-1);
  for (let f = 0; f < faces; f++) {
    const n = faceNormal(positions, indices, f * 3);
    const l = Math.hypot(...n) || 1;
    for (let k = 0; k < 3; k++) {
      normal[f * 3 + k] = n[k]!;
      unit[f * 3 + k] = n[k]! / l;
      const w = weld[indices[f * 3 + k]!]!;
      next[f * 3 + k] = first[w]!;
      first[w] = f * 3 + k;
    }
  }
  const limit = Math.cos(angle);
  const p: number[] = [];
  const normals: number[] = [];
  const corners = new Uint32Array(indices.length);
  // Vertices at each place.
  const madeFirst = new Int32Array(positions.length / 3).fill(-1);
  const madeNext: number[] = [];
  for (let c = 0; c < indices.length; c++) {
    const f = Math.floor(c / 3);
    const w = weld[indices[c]!]!;
    let x = 0;
    let y = 0;
    let z = 0;
    for (let o = first[w]!; o >= 0; o = next[o]!) {
      const g = Math.floor(o / 3) * 3;
      const dot = unit[g]! * unit[f * 3]! + unit[g + 1]! * unit[f * 3 + 1]! + unit[g + 2]! * unit[f * 3 + 2]!;
      if (dot >= limit) {
        x += normal[g]!;
        y += normal[g + 1]!;
        z += normal[g + 2]!;
      }
    }
    const l = Math.hypot(x, y, z) || 1;
    const same = (v: number) =>
      normals[v * 3] === x / l && normals[v * 3 + 1] === y / l && normals[v * 3 + 2] === z / l;
    let v = madeFirst[w]!;
    while (v >= 0 && !same(v)) v = madeNext[v]!;
    if (v < 0) {
      v = madeNext.length;
      madeNext.push(madeFirst[w]!);
      madeFirst[w] = v;
      normals.push(x / l, y / l, z / l);
      for (let k = 0; k < 3; k++) p.push(positions[indices[c]! * 3 + k]!);
    }
    corners[c] = v;
  }
  return { positions: Float32Array.from(p), normals: Float32Array.from(normals), indices: corners };
}

function faceNormal(p: Float32Array, indices: Uint32Array, t: number): [number, number, number] {
  const a = indices[t]! * 3;
  const b = indices[t + 1]! * 3;
  const c = indices[t + 2]! * 3;
  const ux = p[b]! - p[a]!;
  const uy = p[b + 1]! - p[a + 1]!;
  const uz = p[b + 2]! - p[a + 2]!;
  const vx = p[c]! - p[a]!;
  const vy = p[c + 1]! - p[a + 1]!;
  const vz = p[c + 2]! - p[a + 2]!;
  return [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
}

/** For each vertex, the first one within a micrometre. */
function weldMap(p: Float32Array): Uint32Array {
  const seen = new Map<string, number>();
  const out = new Uint32Array(p.length / 3);
  for (let v = 0; v < out.length; v++) {
    const key = `${Math.round(p[v * 3]! * 1e6)},${Math.round(p[v * 3 + 1]! * 1e6)},${Math.round(p[v * 3 + 2]! * 1e6)}`;
    const s = seen.get(key);
    if (s === undefined) seen.set(key, v);
    out[v] = s ?? v;
  }
  return out;
}

/** a and b of each vertex side by side. */
export function interleave(a: ArrayLike<number>, b: ArrayLike<number>): Float32Array {
  const out = new Float32Array(a.length * 2);
  for (let i = 0; i < a.length; i++) {
    out[i * 2] = a[i]!;
    out[i * 2 + 1] = b[i]!;
  }
  return out;
}
