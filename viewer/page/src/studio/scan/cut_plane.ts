// SPDX-License-Identifier: GPL-3.0-or-later
// A cut from a line that was drawn across a vessel: the plane through that line along the direction of view, and the
// part that goes (tools/case_builder/cut_off.cpp).
import { Vector3 } from 'three';

export interface Cut {
  point: Vector3;
  /** To the part that goes. */
  normal: Vector3;
}

/** What is seen: rays through a point of the drawn line, share 0 to 1. */
export interface Sight {
  direction(share: number): Vector3;
  /** Where the ray meets the surface, from the nearest on. */
  hits(share: number): Vector3[];
}

const samples = 48;

/** Null: the line does not go across a vessel. Its direction says nothing about the part that goes. */
export function cutThrough(sight: Sight): Cut | null {
  const normal = sight.direction(0).cross(sight.direction(1));
  if (normal.length() < 1e-6) return null;
  // The longest piece of the line that lies on the vessel.
  let [best, from]: [[number, number] | null, number] = [null, -1];
  for (let k = 0; k <= samples + 1; k++) {
    const on = k <= samples && sight.hits(k / samples).length > 0;
    if (on && from < 0) from = k;
    if (on || from < 0) continue;
    if (!best || k - from > best[1] - best[0]) best = [from, k];
    from = -1;
  }
  if (!best) return null;
  const [near, far] = sight.hits((best[0] + best[1] - 1) / 2 / samples);
  if (!near) return null;
  return { point: far ? near.clone().add(far).multiplyScalar(0.5) : near.clone(), normal: normal.normalize() };
}

export const otherSide = ({ point, normal }: Cut): Cut => ({ point, normal: normal.clone().negate() });

/** 1 for each vertex that goes: what is connected with the far side of the cut at its point. */
export function partBeyond(
  positions: ArrayLike<number>,
  triangles: ArrayLike<number>,
  { point, normal }: Cut,
): Uint8Array {
  const count = positions.length / 3;
  const over = new Float32Array(count);
  const at = new Vector3();
  const place = (v: number) => at.set(positions[3 * v]!, positions[3 * v + 1]!, positions[3 * v + 2]!);
  for (let v = 0; v < count; v++) over[v] = place(v).sub(point).dot(normal);
  const next: number[][] = Array.from({ length: count }, () => []);
  let [start, least] = [-1, Infinity];
  for (let t = 0; t < triangles.length; t += 3)
    for (let k = 0; k < 3; k++) {
      const [a, b] = [triangles[t + k]!, triangles[t + ((k + 1) % 3)]!];
      next[a]!.push(b);
      if (over[a]! > 0 || over[b]! <= 0) continue;
      const away = place(b).distanceTo(point);
      if (away < least) [start, least] = [b, away];
    }
  const out = new Uint8Array(count);
  const list = start < 0 ? [] : [start];
  for (const v of list) out[v] = 1;
  for (let n = 0; n < list.length; n++)
    for (const to of next[list[n]!]!)
      if (out[to] === 0 && over[to]! > 0) {
        out[to] = 1;
        list.push(to);
      }
  return out;
}

/** Turned so that the smaller part goes, and never that with the neck. */
export function smallerSide(
  positions: ArrayLike<number>,
  triangles: ArrayLike<number>,
  cut: Cut,
  neck: Vector3 | null,
): Cut {
  if (neck) return neck.clone().sub(cut.point).dot(cut.normal) > 0 ? otherSide(cut) : cut;
  const size = (c: Cut) => partBeyond(positions, triangles, c).reduce((sum, one) => sum + one, 0);
  return size(cut) <= size(otherSide(cut)) ? cut : otherSide(cut);
}
