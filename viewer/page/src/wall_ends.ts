// SPDX-License-Identifier: GPL-3.0-or-later
// A vessel that goes on beyond its model is not cut off in the picture: its last millimetres bend into the tissue that
// lies nearest to them.
import type { EndData } from './bundle_types';
import { PointGrid } from './spatial';

/** So much of a vessel bends, in radii of its end. */
const bentRadii = 6;
/** Tissue is sought this far from an end, m. */
const reachM = 0.014;

type Vector = [number, number, number];

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Where each end goes: out of its cap and down to below the tissue's surface; without tissue, `away`. */
export function endShift(end: EndData, tissues: readonly Float32Array[], away: Vector): Vector {
  let best: Vector | null = null;
  let least = reachM;
  for (const positions of tissues) {
    const v = new PointGrid(positions, 0.003).nearest(...end.centreM, reachM);
    if (v < 0) continue;
    const to = [0, 1, 2].map((k) => positions[3 * v + k]! - end.centreM[k]!) as Vector;
    const length = Math.hypot(...to);
    if (length >= least) continue;
    least = length;
    best = to;
  }
  const length = best ? Math.max(1e-6, Math.hypot(...best)) : 1;
  // The whole end has to vanish: two radii below the surface.
  const depth = best ? length + 2 * end.radiusM : 5 * end.radiusM;
  const down = best ? (best.map((x) => x / length) as Vector) : away;
  return [0, 1, 2].map((k) => down[k]! * depth + end.outward[k]! * 1.5 * end.radiusM) as Vector;
}

/** 0 along a vessel ... 1 at the cap of one of its ends. */
export function endShare(place: ArrayLike<number>, at: number, end: EndData): number {
  const bent = bentRadii * end.radiusM;
  const from = [0, 1, 2].map((k) => place[at + k]! - end.centreM[k]!) as Vector;
  const behind = -dot(from, end.outward);
  const beside = Math.hypot(...[0, 1, 2].map((k) => from[k]! + behind * end.outward[k]!));
  if (behind > bent || behind < -end.radiusM || beside > 2.2 * end.radiusM) return 0;
  return 1 - Math.max(0, behind) / bent;
}

/** A copy of `positions` whose ends are bent by their shifts, smoothly from nothing to the whole. */
export function bendEnds(
  positions: Float32Array,
  ends: readonly EndData[],
  shifts: readonly Vector[],
): Float32Array<ArrayBuffer> {
  const out = Float32Array.from(positions);
  ends.forEach((end, e) => {
    for (let v = 0; v < out.length; v += 3) {
      const share = endShare(positions, v, end);
      for (let k = 0; k < 3; k++) out[v + k] = out[v + k]! + shifts[e]![k]! * share * share;
    }
  });
  return out;
}
