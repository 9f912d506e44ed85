// SPDX-License-Identifier: GPL-3.0-or-later
// What is baked at load, on shapes whose answer is known: a ball is open and convex, a closed gap between plates is
// dark; vessels lie on the surface and grow the same way every time; creased normals keep a cube's faces flat.
import { describe, expect, it } from 'vitest';
import { creased, smoothNormals } from '../src/geometry';
import { bakeShading, type Tissue } from '../src/occlusion';
import { growVessels, makeTubes } from '../src/surface_vessels';

/** Latitude-longitude ball. */
function ball(radius: number, rows: number, columns: number): Tissue {
  const positions: number[] = [];
  const indices: number[] = [];
  for (let i = 0; i <= rows; i++)
    for (let j = 0; j < columns; j++) {
      const a = (Math.PI * (i + 0.5)) / (rows + 1);
      const b = (2 * Math.PI * j) / columns;
      positions.push(radius * Math.sin(a) * Math.cos(b), radius * Math.sin(a) * Math.sin(b), radius * Math.cos(a));
      if (i === rows) continue;
      const p = i * columns + j;
      const q = i * columns + ((j + 1) % columns);
      indices.push(p, p + columns, q, q, p + columns, q + columns);
    }
  const p = Float32Array.from(positions);
  const t = Uint32Array.from(indices);
  return { positions: p, indices: t, normals: smoothNormals(p, t) };
}

function plate(z: number, up: boolean): Tissue {
  const n = 21;
  const positions: number[] = [];
  const indices: number[] = [];
  for (let i = 0; i < n; i++)
    for (let j = 0; j < n; j++) {
      positions.push((i - 10) * 0.001, (j - 10) * 0.001, z);
      if (i + 1 === n || j + 1 === n) continue;
      const a = i * n + j;
      const b = a + 1;
      const c = a + n;
      const d = c + 1;
      if (up) indices.push(a, c, b, b, c, d);
      else indices.push(a, b, c, b, d, c);
    }
  const p = Float32Array.from(positions);
  const t = Uint32Array.from(indices);
  return { positions: p, indices: t, normals: smoothNormals(p, t) };
}

describe('baked shading', () => {
  it('finds a ball open and convex all over', () => {
    const [s] = bakeShading([ball(0.02, 50, 100)]);
    expect(Math.min(...s!.openness)).toBeGreaterThan(0.97);
    expect(Math.min(...s!.convexity)).toBeGreaterThan(0.1);
  });

  it('darkens facing plates by how near they are', () => {
    const middle = 10 * 21 + 10;
    const at = (gap: number) => bakeShading([plate(0, true), plate(gap, false)])[0]!.openness[middle]!;
    expect(bakeShading([plate(0, true)])[0]!.openness[middle]).toBeCloseTo(1, 6);
    expect(at(0.001)).toBeLessThan(at(0.004));
    expect(at(0.001)).toBeLessThan(0.5);
    expect(bakeShading([plate(0, true), plate(0.004, false)])[1]!.openness[middle]).toBeCloseTo(at(0.004), 2);
    // Backs do not shade.
    expect(bakeShading([plate(0, true), plate(0.002, true)])[0]!.openness[middle]).toBeCloseTo(1, 6);
  });
});

describe('vessels', () => {
  const t = ball(0.02, 70, 140);
  const shading = {
    openness: new Float32Array(t.positions.length / 3).fill(0.6),
    convexity: new Float32Array(t.positions.length / 3),
  };
  const style = {
    densityM2: 4000,
    radiusM: [0.0002, 0.0005] as [number, number],
    lengthM: [0.015, 0.03] as [number, number],
    veinShare: 0.5,
  };

  it('lie on the surface, half sunk, and taper', () => {
    const vessels = growVessels(t, shading, style, 3);
    expect(vessels.length).toBeGreaterThan(8);
    for (const v of vessels) for (const p of v.points) expect(Math.abs(Math.hypot(...p) - 0.02)).toBeLessThan(0.00015);
    for (const v of vessels) expect(v.radii[v.radii.length - 1]!).toBeLessThan(0.7 * Math.max(...v.radii));
    const tubes = makeTubes(vessels);
    expect(tubes.positions.length / 3).toBe(tubes.kind.length);
    expect(tubes.foot.length).toBe(tubes.positions.length);
    expect(Math.max(...tubes.indices.slice(0, 60000))).toBeLessThan(tubes.kind.length);
  });

  it('are not more than a page can draw on a body whose unit is wrong', () => {
    const huge = { ...t, positions: t.positions.map((x) => 1000 * x) };
    const began = performance.now();
    expect(growVessels(huge, shading, style, 3).length).toBeLessThan(601);
    expect(performance.now() - began).toBeLessThan(10_000);
  });

  it('are the same for the same seed and differ for another', () => {
    const a = growVessels(t, shading, style, 3);
    const b = growVessels(t, shading, style, 3);
    const c = growVessels(t, shading, style, 4);
    expect(a).toEqual(b);
    expect(a).not.toEqual(c);
  });
});

describe('normals', () => {
  it('keeps a cube flat when creased and rounds it when smoothed', () => {
    const p = Float32Array.from([0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) => [i & 1, (i >> 1) & 1, i >> 2]));
    const quads = [
      [0, 2, 3, 1],
      [4, 5, 7, 6],
      [0, 1, 5, 4],
      [2, 6, 7, 3],
      [0, 4, 6, 2],
      [1, 3, 7, 5],
    ];
    const idx = Uint32Array.from(quads.flatMap(([a, b, c, d]) => [a!, b!, c!, a!, c!, d!]));
    const cube = creased(p, idx, 0.6);
    const flat = cube.normals;
    // Four corners of each of six faces, and each triangle where it was.
    expect(flat.length / 3).toBe(24);
    cube.indices.forEach((v, c) => {
      for (let k = 0; k < 3; k++) expect(cube.positions[3 * v + k]).toBe(p[3 * idx[c]! + k]);
    });
    expect(creased(p, idx, 3).normals.length / 3).toBe(8);
    for (let i = 0; i < flat.length; i += 3)
      expect(Math.max(...[0, 1, 2].map((k) => Math.abs(flat[i + k]!)))).toBeCloseTo(1, 6);
    const round = smoothNormals(p, idx);
    for (let v = 0; v < 8; v++)
      for (let k = 0; k < 3; k++) expect(Math.sign(round[v * 3 + k]!)).toBe(p[v * 3 + k] ? 1 : -1);
  });
});
