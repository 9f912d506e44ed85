// SPDX-License-Identifier: GPL-3.0-or-later
// Pial vessels: arteries and veins grown over a tissue surface at load as branching random walks that are drawn into
// the sulci, and made into half-sunk tubes.
import { makeRandom } from './random';
import type { Shading, Tissue } from './occlusion';
import { PointGrid } from './spatial';

export interface Vessel {
  kind: 'artery' | 'vein';
  points: number[][];
  normals: number[][];
  radii: number[];
  /** The first point lies in the tissue, not in a parent vessel. */
  sunkStart?: boolean;
}

export interface VesselStyle {
  /** Trees per square metre of surface. */
  densityM2: number;
  radiusM: [number, number];
  lengthM: [number, number];
  veinShare: number;
}

const styles: Record<string, VesselStyle> = {
  cortex: { densityM2: 11000, radiusM: [0.00018, 0.0005], lengthM: [0.018, 0.05], veinShare: 0.52 },
  insula: { densityM2: 5000, radiusM: [0.0004, 0.001], lengthM: [0.02, 0.045], veinShare: 0.12 },
};

/** By the name of the tissue's material; cortex where it is another. */
export const vesselStyleOf = (material: string): VesselStyle => styles[material] ?? styles.cortex!;

const stepM = 0.0006;
/** A lobe has some hundred. A body of many metres, whose unit is wrong, would have millions. */
const mostTrees = 600;
/** Of a trunk that is drawn as thick as any, m. */
const thickestM = 0.0006;

/** Walks over a point-sampled surface; each step is projected onto the local average plane, so paths are smooth. */
class Walker {
  private readonly grid: PointGrid;
  constructor(
    private readonly t: Tissue,
    private readonly convexity: Float32Array,
  ) {
    this.grid = new PointGrid(t.positions, 0.0015);
  }

  /**
   * Foot point and normal near q, or null off the mesh; `downhill`: tangent towards the nearest fold, as long as the
   * surface's convexity falls over a millimetre.
   */
  project(q: number[]): { x: number[]; n: number[]; downhill: number[] } | null {
    let w = 0;
    let planes = 0;
    const c = [0, 0, 0];
    const n = [0, 0, 0];
    let near = Infinity;
    let level = 0;
    const rise = [0, 0, 0];
    this.grid.near(q[0]!, q[1]!, q[2]!, 0.0022, (i, d2) => {
      const g = Math.exp(-d2 / 0.7e-6);
      const v = i * 3;
      for (let k = 0; k < 3; k++) planes += g * (q[k]! - this.t.positions[v + k]!) * this.t.normals[v + k]!;
      near = Math.min(near, d2);
      w += g;
      for (let k = 0; k < 3; k++) {
        c[k] = c[k]! + g * this.t.positions[i * 3 + k]!;
        n[k] = n[k]! + g * this.t.normals[i * 3 + k]!;
        rise[k] = rise[k]! + g * this.convexity[i]! * (this.t.positions[v + k]! - q[k]!);
      }
      level += g * this.convexity[i]!;
    });
    if (!(w > 0) || near > 1.4e-6) return null;
    const l = Math.hypot(n[0]!, n[1]!, n[2]!);
    // Opposite walls of a sulcus cancel: no surface to follow there.
    if (l < 0.5 * w) return null;
    for (let k = 0; k < 3; k++) {
      c[k] = c[k]! / w;
      n[k] = n[k]! / l;
    }
    // The mean point lies below a bulging surface, the mean of the tangent planes as far above it: halfway is right.
    const below = (q[0]! - c[0]!) * n[0]! + (q[1]! - c[1]!) * n[1]! + (q[2]! - c[2]!) * n[2]!;
    const h = 0.5 * (below + planes / w);
    // Covariance of convexity and place over that of place: its slope.
    const slope = rise.map((r, k) => -(r / w - (level / w) * (c[k]! - q[k]!)) / 0.35e-6 / 1000);
    const out = slope[0]! * n[0]! + slope[1]! * n[1]! + slope[2]! * n[2]!;
    const downhill = slope.map((x, k) => x - out * n[k]!);
    return { x: [q[0]! - h * n[0]!, q[1]! - h * n[1]!, q[2]! - h * n[2]!], n, downhill };
  }
}

/** A vessel that is to be grown. */
interface Shoot {
  kind: Vessel['kind'];
  start: number[];
  direction: number[];
  radius: number;
  length: number;
  /** 0: a trunk; k: a branch of the order k. */
  depth: number;
  /** Points of its own tree, which may touch itself. */
  own: number[][];
}

class Grower {
  readonly vessels: Vessel[] = [];
  private readonly walker: Walker;
  private readonly taken: number[][] = [];

  constructor(
    tissue: Tissue,
    convexity: Float32Array,
    private readonly random: () => number,
  ) {
    this.walker = new Walker(tissue, convexity);
  }

  grow(shoot: Shoot): Vessel | null {
    const { kind, radius, depth, own } = shoot;
    const vessel: Vessel = { kind, points: [], normals: [], radii: [] };
    const branches = this.walk(vessel, shoot);
    const reached = vessel.points.length;
    if (reached < (depth === 0 ? 22 : 7)) return null;
    // Cut short by a neighbour or an edge: the taper follows the length that was reached.
    const thick = radius * Math.min(1, depth === 0 ? 1 : 0.45 + reached / 60);
    vessel.radii = vessel.radii.map(
      (_, i) => thick * (0.3 + 0.7 * Math.sqrt(1 - i / reached)) * (1 + 0.06 * (this.random() - 0.5)),
    );
    // Everything of this tree may touch itself; other trees stay clear of it.
    for (let i = 0; i < vessel.points.length; i += 2) {
      this.taken.push(vessel.points[i]!);
      own.push(vessel.points[i]!);
    }
    if (depth > 0) this.vessels.push(vessel);
    for (const b of branches) this.grow(b);
    return vessel;
  }

  /** Steps over the surface until the length is reached, an edge or another tree is met. Returns what branches off. */
  private walk(vessel: Vessel, shoot: Shoot): Shoot[] {
    const { kind, radius, length, depth, own } = shoot;
    const { random } = this;
    let x = shoot.start;
    let d = shoot.direction;
    let bend = 0;
    const steps = Math.round(length / stepM);
    const branches: Shoot[] = [];
    let sinceBranch = 0;
    for (let s = 0; s < steps; s++) {
      const foot = this.walker.project(x);
      if (!foot) break;
      if (s > 6 && !this.free(foot.x, own, radius * 1.5 + 0.0006)) break;
      const n = foot.n;
      const along = d[0]! * n[0]! + d[1]! * n[1]! + d[2]! * n[2]!;
      d = unit([d[0]! - along * n[0]!, d[1]! - along * n[1]!, d[2]! - along * n[2]!]);
      vessel.points.push(foot.x);
      vessel.normals.push(n);
      const left = 1 - s / steps;
      vessel.radii.push(radius * (0.3 + 0.7 * Math.sqrt(left)) * (1 + 0.06 * (random() - 0.5)));
      // Meander: a slowly changing turn about the normal.
      bend = 0.86 * bend + (random() - 0.5) * (kind === 'artery' ? 0.34 : 0.22);
      d = turn(d, n, bend * 0.42);
      // Trunks run along the sulci, branches leave them.
      const pull = depth === 0 ? 0.28 : 0.08;
      d = unit(d.map((v, k) => v + pull * foot.downhill[k]!));
      sinceBranch++;
      if (depth < 4 && sinceBranch > 6 && s < steps - 6 && random() < 0.12) {
        sinceBranch = 0;
        const side = random() < 0.5 ? -1 : 1;
        const direction = turn(d, n, side * (0.6 + 0.5 * random()));
        const thin = vessel.radii[s]! * (0.55 + 0.2 * random());
        const short = length * left * (0.5 + 0.4 * random());
        branches.push({ kind, start: foot.x, direction, radius: thin, length: short, depth: depth + 1, own });
      }
      x = [foot.x[0]! + d[0]! * stepM, foot.x[1]! + d[1]! * stepM, foot.x[2]! + d[2]! * stepM];
    }
    return branches;
  }

  /** No other tree is within the clearance. */
  private free(x: number[], own: number[][], clearance: number): boolean {
    const far = (t: number[]) =>
      (t[0]! - x[0]!) ** 2 + (t[1]! - x[1]!) ** 2 + (t[2]! - x[2]!) ** 2 > clearance * clearance;
    return this.taken.every((t) => far(t) || own.includes(t));
  }
}

/** Seeds lie at the lips of sulci and of the fissure, where the vessels come up; they keep their distance. */
function seedsOf(tissue: Tissue, shading: Shading, density: number, random: () => number): number[] {
  const p = tissue.positions;
  let area = 0;
  for (let i = 0; i < tissue.indices.length; i += 3) area += triangleArea(p, tissue.indices, i);
  const trees = Math.min(mostTrees, Math.round(area * density));
  const seeds: number[] = [];
  const spacing = 0.7 * Math.sqrt(1 / density);
  for (let tries = 0; tries < trees * 60 && seeds.length < trees; tries++) {
    const v = Math.floor((random() * p.length) / 3);
    if (shading.openness[v]! < 0.3 || shading.openness[v]! > 0.9) continue;
    if (seeds.some((s) => distance(p, s, p, v) < spacing)) continue;
    seeds.push(v);
  }
  return seeds;
}

export function growVessels(tissue: Tissue, shading: Shading, style: VesselStyle, seed: number): Vessel[] {
  const random = makeRandom(seed);
  const grower = new Grower(tissue, shading.convexity, random);
  for (const v of seedsOf(tissue, shading, style.densityM2, random)) {
    const n = [...tissue.normals.subarray(v * 3, v * 3 + 3)];
    const around = random() * Math.PI * 2;
    const side = unit(Math.abs(n[0]!) < 0.8 ? [0, n[2]!, -n[1]!] : [n[1]!, -n[0]!, 0]);
    const kind = random() < style.veinShare ? 'vein' : 'artery';
    const size = style.radiusM[0] + (style.radiusM[1] - style.radiusM[0]) * random() ** 2;
    const length = style.lengthM[0] + (style.lengthM[1] - style.lengthM[0]) * random();
    const start = [...tissue.positions.subarray(v * 3, v * 3 + 3)];
    const direction = turn(side, n, around);
    const radius = size * (kind === 'vein' ? 1.3 : 1);
    // A trunk runs to both sides of its seed.
    const trunk: Shoot = { kind, start, direction, radius, length, depth: 0, own: [] };
    const one = grower.grow(trunk);
    const other = one && grower.grow({ ...trunk, direction: direction.map((x) => -x), length: length * 0.6 });
    if (one) grower.vessels.push(other ? join(other, one) : { ...one, sunkStart: true });
  }
  return grower.vessels;
}

/** Two halves that start at the same point, as one path. */
function join(a: Vessel, b: Vessel): Vessel {
  const both = <T>(x: T[], y: T[]) => [...x.slice(1).reverse(), ...y];
  return {
    kind: a.kind,
    points: both(a.points, b.points),
    normals: both(a.normals, b.normals),
    radii: both(a.radii, b.radii),
    sunkStart: true,
  };
}

export interface TubeData {
  positions: number[];
  normals: number[];
  indices: number[];
  /** 0 artery, 1 vein. */
  kind: number[];
  /** 0 capillary ... 1 the thickest trunk. */
  calibre: number[];
  /** Surface point below each vertex, for shading and skinning. */
  foot: number[];
}

export function makeTubes(vessels: Vessel[]): TubeData {
  const out: TubeData = { positions: [], normals: [], indices: [], kind: [], calibre: [], foot: [] };
  for (const v of vessels) {
    const points = smoothPath(v.points);
    const sides = Math.max(...v.radii) > 0.0003 ? 8 : 5;
    const base = out.positions.length / 3;
    for (let i = 0; i < points.length; i++) {
      const a = points[Math.max(0, i - 1)]!;
      const b = points[Math.min(points.length - 1, i + 1)]!;
      const t = unit([b[0]! - a[0]!, b[1]! - a[1]!, b[2]! - a[2]!]);
      const n = v.normals[i]!;
      const s = unit(cross(t, n));
      // The far end sinks into the tissue instead of stopping in the air; the near one lies in the parent or the
      // other half.
      const rise = Math.min(1, (points.length - 1 - i) / 4, v.sunkStart ? i / 4 : 1);
      const r = v.radii[i]!;
      const lift = r * (0.5 * rise - 0.8 * (1 - rise)) + 0.00004;
      for (let k = 0; k < sides; k++) {
        const angle = (k / sides) * Math.PI * 2;
        const c = Math.cos(angle);
        const h = Math.sin(angle);
        for (let j = 0; j < 3; j++) {
          out.positions.push(points[i]![j]! + n[j]! * (lift + 0.8 * r * h) + s[j]! * r * c);
          out.normals.push(n[j]! * h * 1.1 + s[j]! * c);
          out.foot.push(points[i]![j]!);
        }
        out.kind.push(v.kind === 'vein' ? 1 : 0);
        out.calibre.push(Math.min(1, r / thickestM));
        if (i + 1 < points.length) {
          const p00 = base + i * sides + k;
          const p01 = base + i * sides + ((k + 1) % sides);
          out.indices.push(p00, p00 + sides, p01, p01, p00 + sides, p01 + sides);
        }
      }
    }
  }
  return out;
}

function smoothPath(points: number[][]): number[][] {
  let now = points;
  for (let n = 0; n < 3; n++)
    now = now.map((p, i) =>
      i === 0 || i === now.length - 1 ? p : p.map((x, k) => 0.5 * x + 0.25 * (now[i - 1]![k]! + now[i + 1]![k]!)),
    );
  return now;
}

const cross = (a: number[], b: number[]) => [
  a[1]! * b[2]! - a[2]! * b[1]!,
  a[2]! * b[0]! - a[0]! * b[2]!,
  a[0]! * b[1]! - a[1]! * b[0]!,
];

function unit(v: number[]): number[] {
  const l = Math.hypot(v[0]!, v[1]!, v[2]!) || 1;
  return [v[0]! / l, v[1]! / l, v[2]! / l];
}

/** Rotates tangent d about unit normal n. */
function turn(d: number[], n: number[], angle: number): number[] {
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  const x = cross(n, d);
  return unit([d[0]! * c + x[0]! * s, d[1]! * c + x[1]! * s, d[2]! * c + x[2]! * s]);
}

function distance(a: Float32Array, i: number, b: Float32Array, j: number): number {
  return Math.hypot(a[i * 3]! - b[j * 3]!, a[i * 3 + 1]! - b[j * 3 + 1]!, a[i * 3 + 2]! - b[j * 3 + 2]!);
}

function triangleArea(p: Float32Array, idx: Uint32Array, i: number): number {
  const a = idx[i]! * 3;
  const b = idx[i + 1]! * 3;
  const c = idx[i + 2]! * 3;
  const u = [p[b]! - p[a]!, p[b + 1]! - p[a + 1]!, p[b + 2]! - p[a + 2]!];
  const v = [p[c]! - p[a]!, p[c + 1]! - p[a + 1]!, p[c + 2]! - p[a + 2]!];
  const n = cross(u, v);
  return Math.hypot(n[0]!, n[1]!, n[2]!) / 2;
}
