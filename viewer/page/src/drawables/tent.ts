// SPDX-License-Identifier: GPL-3.0-or-later
// Where the tip of a tent is over its piece of membrane.

/** A bilinear piece: its corners (0,0), (0,1), (1,0), (1,1), three numbers each; s leads across, t along the fibres. */
export type Corners = ArrayLike<number>;

export interface Tent {
  /** Foot of the tip on the piece. */
  s: number;
  t: number;
  /** From the foot to the tip, m. */
  rise: [number, number, number];
}

const along = (c: Corners, s: number, t: number, k: number): number =>
  (1 - s) * ((1 - t) * c[k]! + t * c[3 + k]!) + s * ((1 - t) * c[6 + k]! + t * c[9 + k]!);

/** By Newton's method; a foot beyond an edge is moved onto it, and the rise is from there. */
export function tentOf(corners: Corners, tip: ArrayLike<number>): Tent {
  let s = 0.5;
  let t = 0.5;
  for (let i = 0; i < 8; i++) {
    let [gs, gt, ss, st, tt] = [0, 0, 0, 0, 0];
    for (let k = 0; k < 3; k++) {
      const twist = corners[k]! - corners[3 + k]! - corners[6 + k]! + corners[9 + k]!;
      const ds = corners[6 + k]! - corners[k]! + t * twist;
      const dt = corners[3 + k]! - corners[k]! + s * twist;
      const gap = tip[k]! - along(corners, s, t, k);
      gs += gap * ds;
      gt += gap * dt;
      ss += ds * ds;
      st += ds * dt - gap * twist;
      tt += dt * dt;
    }
    const det = ss * tt - st * st;
    if (!(det > 1e-6 * ss * tt)) break;
    s = Math.max(0, Math.min(1, s + (tt * gs - st * gt) / det));
    t = Math.max(0, Math.min(1, t + (ss * gt - st * gs) / det));
  }
  const rise = [0, 1, 2].map((k) => tip[k]! - along(corners, s, t, k)) as [number, number, number];
  return { s, t, rise };
}
