// SPDX-License-Identifier: GPL-3.0-or-later
// A made-up artery for the mock: a parent vessel that forks, with a sac and a bleb at the fork, as the level set of a
// smooth union of capsules and balls, extracted by surface nets; a coarse wall and a finer picture surface that rides
// on it.

const sub = (a, b) => a.map((x, i) => x - b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const mix = (a, b, t) => a.map((x, i) => x + (b[i] - x) * t);

export const regions = ['parent', 'superior', 'inferior', 'neck', 'sac', 'bleb', 'ends'];

// Millimetres, the frame of the lobes: along the free channel of the fissure.
const fork = [48.2, 15, -9.2];
const tubes = [
  { region: 0, path: [[36, 13, -19.5], [41, 14.6, -17], [45, 14.4, -13], fork], radius: [1.45, 1.4] },
  { region: 1, path: [fork, [48.4, 16.6, -6.6], [47.4, 18.6, -4.6], [46.6, 20.6, -2.4]], radius: [1.05, 0.85] },
  { region: 2, path: [fork, [50, 13.2, -7], [51, 10.6, -5.6], [51.4, 7.6, -3.6], [50, 4, -2.4]], radius: [1.1, 0.8] },
];
export const neck = [49.2, 15.4, -9.0];
export const sac = [51.3, 16.0, -8.3];
export const bleb = [53.2, 17.1, -7.4];
const sacRadius = 2.75;
const blebRadius = 1.15;

function tubeDistance(t, p) {
  let best = Infinity;
  for (let i = 0; i + 1 < t.path.length; i++) {
    const a = t.path[i];
    const d = sub(t.path[i + 1], a);
    const s = Math.max(0, Math.min(1, dot(sub(p, a), d) / dot(d, d)));
    const along = (i + s) / (t.path.length - 1);
    best = Math.min(
      best,
      Math.hypot(...sub(p, mix(a, t.path[i + 1], s))) - (t.radius[0] + (t.radius[1] - t.radius[0]) * along),
    );
  }
  return best;
}

const blend = (a, b, k) => {
  const h = Math.max(0, k - Math.abs(a - b)) / k;
  return Math.min(a, b) - h * h * k * 0.25;
};

function distance(p) {
  let d = tubeDistance(tubes[0], p);
  d = blend(d, tubeDistance(tubes[1], p), 0.9);
  d = blend(d, tubeDistance(tubes[2], p), 0.9);
  d = blend(d, Math.hypot(...sub(p, sac)) - sacRadius, 0.7);
  return blend(d, Math.hypot(...sub(p, bleb)) - blebRadius, 0.5);
}

/** Axes across each axis, and the cells about an edge. */
const crossAxes = [
  [
    [0, 1, 0],
    [0, 0, 1],
  ],
  [
    [0, 0, 1],
    [1, 0, 0],
  ],
  [
    [1, 0, 0],
    [0, 1, 0],
  ],
];
const corners = [
  [0, 0],
  [1, 0],
  [1, 1],
  [0, 1],
];

/** Mean of where the surface crosses the edges of a cell, in cells; null: it does not. */
function meanCrossing(value, at, i, j, k) {
  let count = 0;
  const sum = [0, 0, 0];
  for (let e = 0; e < 12; e++) {
    const axis = e >> 2;
    const u = e & 1;
    const v = (e >> 1) & 1;
    const a = axis === 0 ? [0, u, v] : axis === 1 ? [u, 0, v] : [u, v, 0];
    const b = a.map((x, q) => (q === axis ? 1 : x));
    const va = value[at(i + a[0], j + a[1], k + a[2])];
    const vb = value[at(i + b[0], j + b[1], k + b[2])];
    if (va < 0 === vb < 0) continue;
    const t = va / (va - vb);
    for (let q = 0; q < 3; q++) sum[q] += a[q] + (b[q] - a[q]) * t;
    count++;
  }
  return count === 0 ? null : sum.map((x) => x / count);
}

/** Naive surface nets: one vertex in each cell that the surface crosses, a quad about each crossed edge. */
function surfaceNets(h) {
  const low = [33, 1.5, -22.5];
  const high = [55.5, 22.5, 0];
  const n = low.map((l, k) => Math.ceil((high[k] - l) / h) + 1);
  const at = (i, j, k) => (k * n[1] + j) * n[0] + i;
  const value = new Float32Array(n[0] * n[1] * n[2]);
  for (let k = 0; k < n[2]; k++)
    for (let j = 0; j < n[1]; j++)
      for (let i = 0; i < n[0]; i++) value[at(i, j, k)] = distance([low[0] + i * h, low[1] + j * h, low[2] + k * h]);
  const cell = new Int32Array(value.length).fill(-1);
  const positions = [];
  const indices = [];
  for (let k = 0; k + 1 < n[2]; k++)
    for (let j = 0; j + 1 < n[1]; j++)
      for (let i = 0; i + 1 < n[0]; i++) {
        const crossing = meanCrossing(value, at, i, j, k);
        if (!crossing) continue;
        cell[at(i, j, k)] = positions.length / 3;
        positions.push(...[i, j, k].map((x, q) => low[q] + (x + crossing[q]) * h));
      }
  for (let k = 1; k + 1 < n[2]; k++)
    for (let j = 1; j + 1 < n[1]; j++)
      for (let i = 1; i + 1 < n[0]; i++) {
        const here = value[at(i, j, k)];
        for (let axis = 0; axis < 3; axis++) {
          const step = [0, 0, 0];
          step[axis] = 1;
          const there = value[at(i + step[0], j + step[1], k + step[2])];
          if (here < 0 === there < 0) continue;
          const [u, v] = crossAxes[axis];
          const c = corners.map(
            ([a, b]) => cell[at(i - a * u[0] - b * v[0], j - a * u[1] - b * v[1], k - a * u[2] - b * v[2])],
          );
          if (here < 0) indices.push(c[0], c[1], c[2], c[0], c[2], c[3]);
          else indices.push(c[0], c[2], c[1], c[0], c[3], c[2]);
        }
      }
  return { positions: Float32Array.from(positions), indices: Uint32Array.from(indices) };
}

function regionOf(p) {
  const fromNeck = dot(sub(p, neck), sub(sac, neck)) / Math.hypot(...sub(sac, neck));
  if (Math.hypot(...sub(p, bleb)) < blebRadius + 0.25) return 5;
  if (Math.hypot(...sub(p, sac)) < sacRadius + 0.35) return fromNeck < 0.5 ? 3 : 4;
  const d = tubes.map((t) => tubeDistance(t, p));
  const ends = [tubes[0].path[0], tubes[1].path.at(-1), tubes[2].path.at(-1)];
  if (ends.some((e) => Math.hypot(...sub(p, e)) < 1.6)) return 6;
  return d.indexOf(Math.min(...d));
}

/** The wall's triangle that a point rides on, and its weights there. */
function footOn(wall, first, p) {
  const node = (v) => [...wall.positions.subarray(v * 3, v * 3 + 3)];
  let near = 0;
  let least = Infinity;
  for (let w = 0; w < first.length; w++) {
    const d =
      (wall.positions[w * 3] - p[0]) ** 2 +
      (wall.positions[w * 3 + 1] - p[1]) ** 2 +
      (wall.positions[w * 3 + 2] - p[2]) ** 2;
    if (d < least) {
      least = d;
      near = w;
    }
  }
  // Of the triangles about the nearest node the one with the least negative weight.
  let best = -Infinity;
  let triangle = [near, near, near];
  let w3 = [1, 0, 0];
  for (const t of first[near]) {
    const v3 = [...wall.indices.subarray(t, t + 3)];
    const a = node(v3[0]);
    const e1 = sub(node(v3[1]), a);
    const e2 = sub(node(v3[2]), a);
    const d = sub(p, a);
    const g11 = dot(e1, e1);
    const g12 = dot(e1, e2);
    const g22 = dot(e2, e2);
    const det = g11 * g22 - g12 * g12;
    if (!(det > 1e-9)) continue;
    const s = (g22 * dot(d, e1) - g12 * dot(d, e2)) / det;
    const r = (g11 * dot(d, e2) - g12 * dot(d, e1)) / det;
    const w = [1 - s - r, s, r];
    if (Math.min(...w) > best) {
      best = Math.min(...w);
      triangle = v3;
      w3 = w;
    }
  }
  return { triangle, w3 };
}

/** In metres: wall (nodes, indices, region), picture surface with its skinning and regions. */
export function makeArtery() {
  const wall = surfaceNets(0.75);
  const picture = surfaceNets(0.4);
  const region = Uint32Array.from({ length: wall.positions.length / 3 }, (_, v) =>
    regionOf([...wall.positions.subarray(v * 3, v * 3 + 3)]),
  );
  const nv = picture.positions.length / 3;
  const nodes = new Uint32Array(nv * 4);
  const weights = new Float32Array(nv * 4);
  const pictureRegion = new Uint32Array(nv);
  const first = Array.from({ length: region.length }, () => []);
  for (let t = 0; t < wall.indices.length; t += 3) for (let k = 0; k < 3; k++) first[wall.indices[t + k]].push(t);
  for (let v = 0; v < nv; v++) {
    const p = [...picture.positions.subarray(v * 3, v * 3 + 3)];
    const { triangle, w3 } = footOn(wall, first, p);
    nodes.set([...triangle, 0], v * 4);
    weights.set([...w3, 0], v * 4);
    pictureRegion[v] = regionOf(p);
  }
  const metres = (a) => a.map((x) => x / 1000);
  return {
    rest: metres(wall.positions),
    indices: wall.indices,
    region,
    picture: metres(picture.positions),
    picture_indices: picture.indices,
    nodes,
    weights,
    picture_region: pictureRegion,
  };
}

/** Node positions: sac and bleb swell with the pulse, the neck is squeezed by a clip between 0 (none) and 1. */
export function moveArtery(artery, pulse, tension, squeeze, across) {
  const x = Float32Array.from(artery.rest);
  const centre = sac.map((v) => v / 1000);
  const root = neck.map((v) => v / 1000);
  const grow = [0.002, 0.003, 0.003, 0.008, 0.024, 0.036, 0];
  const axis = sub(centre, root);
  const length = Math.hypot(...axis);
  for (let v = 0; v < artery.region.length; v++) {
    const p = [...x.subarray(v * 3, v * 3 + 3)];
    const s =
      grow[artery.region[v]] * (pulse - 0.4) -
      (artery.region[v] === 4 || artery.region[v] === 5 ? 0.05 * (1 - tension) : 0);
    let q = artery.region[v] >= 3 && artery.region[v] <= 5 ? p.map((c, k) => c + (c - centre[k]) * s) : p;
    if (squeeze > 0) {
      const d = sub(q, root);
      const along = dot(d, axis) / length;
      const near = Math.exp(-((along / 0.0011) ** 2)) * (artery.region[v] >= 3 ? 1 : 0.25);
      const off = dot(d, across);
      q = q.map((c, k) => c - across[k] * off * 0.9 * near * squeeze);
    }
    x.set(q, v * 3);
  }
  return x;
}
