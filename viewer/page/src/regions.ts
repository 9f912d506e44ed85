// SPDX-License-Identifier: GPL-3.0-or-later
// Regions of a wall: whose value each vertex shows, how thin the wall looks, and which of its surfaces is drawn.

/**
 * Each vertex whose region is not `known` takes the region of the nearest vertex, along edges, whose region is.
 * Without any known region nothing changes.
 */
export function nearestKnown(region: Uint32Array, indices: Uint32Array, known: readonly boolean[]): Uint32Array {
  const out = Uint32Array.from(region);
  const open = (v: number) => !known[out[v]!];
  let left = out.some((_, v) => open(v)) && out.some((_, v) => !open(v));
  while (left) {
    const before = Uint32Array.from(out);
    let changed = false;
    for (let i = 0; i < indices.length; i += 3)
      for (let k = 0; k < 3; k++)
        for (const o of [1, 2]) {
          const a = indices[i + k]!;
          const b = indices[i + ((k + o) % 3)]!;
          if (!open(a) || !known[before[b]!]) continue;
          out[a] = before[b]!;
          changed = true;
        }
    left = changed && out.some((_, v) => open(v));
  }
  return out;
}

/** 0 of the thickest wall ... 1 of one that has half of its thickness or less. */
export function thinness(thickness: number, thickest: number): number {
  const t = Math.max(0, Math.min(1, (thickness / thickest - 0.5) / 0.5));
  return 1 - t * t * (3 - 2 * t);
}

/**
 * Of each vertex from the thickness of its region, smooth over the borders; regions that are not listed are the
 * thickest.
 */
export function wallThinness(
  region: Uint32Array,
  regions: readonly string[],
  thickness: Readonly<Record<string, number>>,
  indices: Uint32Array,
  rounds = 6,
): Float32Array {
  const thickest = Math.max(...Object.values(thickness), 1e-9);
  const ofRegion = regions.map((r) => thinness(thickness[r] ?? thickest, thickest));
  const out = Float32Array.from(region, (r) => ofRegion[r] ?? 0);
  const sum = new Float32Array(out.length);
  const count = new Float32Array(out.length);
  for (let n = 0; n < rounds; n++) {
    sum.set(out);
    count.fill(1);
    for (let i = 0; i < indices.length; i += 3)
      for (let k = 0; k < 3; k++) {
        const a = indices[i + k]!;
        const b = indices[i + ((k + 1) % 3)]!;
        sum[a] = sum[a]! + out[b]!;
        count[a] = count[a]! + 1;
        sum[b] = sum[b]! + out[a]!;
        count[b] = count[b]! + 1;
      }
    for (let v = 0; v < out.length; v++) out[v] = sum[v]! / count[v]!;
  }
  return out;
}

/**
 * Of the surfaces that show the same wall (same material and regions), the finest alone is drawn: the coarse one,
 * which contact needs, lies in the same place and would show through wherever the fine one is hollow.
 */
export function drawnSurfaces<
  S extends { material: string; regions: readonly string[]; positions: { length: number } },
>(surfaces: readonly S[]): S[] {
  const wall = (s: S) => (s.regions.length > 0 ? `${s.material} ${s.regions.join(' ')}` : null);
  return surfaces.filter(
    (s, i) =>
      wall(s) === null ||
      surfaces.every(
        (o, k) =>
          k === i ||
          wall(o) !== wall(s) ||
          o.positions.length < s.positions.length ||
          (o.positions.length === s.positions.length && k > i),
      ),
  );
}
