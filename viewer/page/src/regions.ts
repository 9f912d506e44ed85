// SPDX-License-Identifier: GPL-3.0-or-later
// Regions of a vessel wall: which measured vessel tells the dye of each, how thin the wall looks, and which
// of its surfaces is drawn.

/** Where a region has no vessel of its own in the engine's list, the first of these that has. */
const stand_in: Record<string, string[]> = {
  bleb: ['sac', 'neck', 'parent'],
  sac: ['neck', 'parent'],
  neck: ['parent', 'bifurcation', 'sac'],
  bifurcation: ['parent'],
};

/** The vessel that speaks for each region; null: none does. */
export function region_vessels(regions: readonly string[], vessels: readonly string[]): (string | null)[] {
  return regions.map((r) => [r, ...(stand_in[r] ?? [])].find((n) => vessels.includes(n)) ?? null);
}

/** Dye of each region from the vessels' list; regions nobody speaks for stay dark. */
export function region_dye(regions: readonly string[], vessels: readonly { id: string; dye: number }[]): number[] {
  return region_vessels(regions, vessels.map((v) => v.id)).map((id) => {
    const dye = vessels.find((v) => v.id === id)?.dye ?? 0;
    return Math.max(0, Math.min(1, dye));
  });
}

/** Ends belong to the vessel they close: each vertex of region `name` takes that of the nearest other vertex along edges. */
export function absorb_region(region: Uint32Array, indices: Uint32Array, name: number): Uint32Array {
  const out = Uint32Array.from(region);
  if (name < 0 || region.every((r) => r === name)) return out;
  let left = out.some((r) => r === name);
  while (left) {
    const before = Uint32Array.from(out);
    let changed = false;
    for (let i = 0; i < indices.length; i += 3)
      for (let k = 0; k < 3; k++) for (const o of [1, 2]) {
        const a = indices[i + k]!, b = indices[i + ((k + o) % 3)]!;
        if (out[a] === name && before[b] !== name) { out[a] = before[b]!; changed = true; }
      }
    left = changed && out.some((r) => r === name);
  }
  return out;
}

const thinness: Record<string, number> = { bleb: 1, sac: 0.78, neck: 0.28 };

/** 0 a thick wall ... 1 the bleb, smooth over the borders of regions. */
export function wall_thinness(region: Uint32Array, regions: readonly string[], indices: Uint32Array, rounds = 6): Float32Array {
  const out = Float32Array.from(region, (r) => thinness[regions[r] ?? ''] ?? 0);
  const sum = new Float32Array(out.length), count = new Float32Array(out.length);
  for (let n = 0; n < rounds; n++) {
    sum.set(out);
    count.fill(1);
    for (let i = 0; i < indices.length; i += 3)
      for (let k = 0; k < 3; k++) {
        const a = indices[i + k]!, b = indices[i + ((k + 1) % 3)]!;
        sum[a] = sum[a]! + out[b]!; count[a] = count[a]! + 1;
        sum[b] = sum[b]! + out[a]!; count[b] = count[b]! + 1;
      }
    for (let v = 0; v < out.length; v++) out[v] = sum[v]! / count[v]!;
  }
  return out;
}

/**
 * Of the surfaces that show the same wall (same material and regions), the finest alone is drawn: the coarse one, which contact
 * needs, lies in the same place and would show through wherever the fine one is hollow.
 */
export function drawn_surfaces<S extends { material: string; regions: readonly string[]; positions: { length: number } }>(surfaces: readonly S[]): S[] {
  const wall = (s: S) => (s.regions.length > 0 ? `${s.material} ${s.regions.join(' ')}` : null);
  return surfaces.filter((s, i) => wall(s) === null || surfaces.every((o, k) => k === i || wall(o) !== wall(s)
    || o.positions.length < s.positions.length || (o.positions.length === s.positions.length && k > i)));
}
