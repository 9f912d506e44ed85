// SPDX-License-Identifier: GPL-3.0-or-later
// Shells and offsets: a picture vertex beside the wall keeps its offset, normals follow the wall's triangles; links
// of tools.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { linkPose } from '../src/link_pose';
import { NodeField, shellTriangles, skinOffsets, skinVertex } from '../src/skinning';

// Two triangles of a wall in the plane z = 0, and a picture vertex above the first.
const rest = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0]);
const nodes = Uint32Array.from([0, 1, 2, 0]);
const weights = Float32Array.from([0.5, 0.25, 0.25, 0]);
const picture = Float32Array.from([0.25, 0.3, 0.125]);
const moved = (f: (x: number[]) => number[]) =>
  Float32Array.from([0, 1, 2, 3].flatMap((i) => f([...rest.subarray(3 * i, 3 * i + 3)])));

describe('offsets', () => {
  it('are what the nodes leave over, and nothing for exact weights', () => {
    const o = skinOffsets(rest, picture, nodes, weights);
    expect([...o].map((x) => Number(x.toFixed(6)))).toEqual([0, 0.05, 0.125]);
    expect([...skinOffsets(rest, [0.25, 0.25, 0], nodes, weights)]).toEqual([0, 0, 0]);
  });

  it('stay constant: sum w x + (X - sum w X)', () => {
    const field = new NodeField(rest, [], Uint32Array.from([0, 1, 2, 1, 3, 2]));
    const offsets = skinOffsets(rest, picture, nodes, weights);
    field.update(moved(([x, y]) => [2 * x! + 3, y! - 1, 0.5]));
    const x: number[] = [];
    const n: number[] = [];
    skinVertex(field, nodes, weights, 0, [0, 0, 1], x, n, offsets);
    expect(x[0]).toBeCloseTo(2 * 0.25 + 3 + 0, 6);
    expect(x[1]).toBeCloseTo(0.25 - 1 + 0.05, 6);
    expect(x[2]).toBeCloseTo(0.5 + 0.125, 6);
    expect(n[2]).toBeCloseTo(1, 6);
  });

  it('gives the rest place at rest, whatever the weights', () => {
    const field = new NodeField(rest, [], Uint32Array.from([0, 1, 2]));
    const x: number[] = [];
    const n: number[] = [];
    skinVertex(field, nodes, weights, 0, [0, 0, 1], x, n, skinOffsets(rest, picture, nodes, weights));
    for (let k = 0; k < 3; k++) expect(x[k]).toBeCloseTo(picture[k]!, 6);
  });
});

describe('shells', () => {
  it('turn their normals with the wall and tilt them with its stretch', () => {
    const field = new NodeField(rest, [], Uint32Array.from([0, 1, 2, 1, 3, 2]));
    const x: number[] = [];
    const n: number[] = [];
    const c = Math.cos(0.7);
    const s = Math.sin(0.7);
    field.update(moved(([a, b]) => [a!, c * b!, s * b!]));
    skinVertex(field, nodes, weights, 0, [0, 0, 1], x, n);
    expect(n[0]).toBeCloseTo(0, 5);
    expect(n[1]).toBeCloseTo(-s, 5);
    expect(n[2]).toBeCloseTo(c, 5);
    // z = 2 x: the plane's normal is (-2, 0, 1).
    field.update(moved(([a, b]) => [a!, b!, 2 * a!]));
    skinVertex(field, nodes, weights, 0, [0, 0, 1], x, n);
    expect(n[0]! / n[2]!).toBeCloseTo(-2, 5);
  });

  it('are found by their weights: three nodes a vertex, or the surface of the nodes themselves', () => {
    const rides = { indices: Uint32Array.from([0, 0, 0]), skinNodes: nodes, skinWeights: weights };
    expect([...shellTriangles([rides])]).toEqual([0, 1, 2]);
    const own = {
      indices: Uint32Array.from([0, 1, 2, 1, 3, 2]),
      skinNodes: Uint32Array.from([0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0]),
      skinWeights: Float32Array.from([1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]),
    };
    expect([...shellTriangles([own, rides])]).toEqual([0, 1, 2, 1, 3, 2]);
    const tet = {
      indices: Uint32Array.from([]),
      skinNodes: Uint32Array.from([0, 1, 2, 3]),
      skinWeights: Float32Array.from([0.25, 0.25, 0.25, 0.25]),
    };
    expect(shellTriangles([tet]).length).toBe(0);
  });
});

describe('links', () => {
  const hinges = [
    { origin: [0, 0, 0.015] as [number, number, number], axis: [0, 1, 0] as [number, number, number], multiplier: 1 },
    { origin: [0, 0, 0.015] as [number, number, number], axis: [0, 2, 0] as [number, number, number], multiplier: -1 },
  ];
  const at = (link: number, opening: number, p: [number, number, number]) =>
    new THREE.Vector3(...p).applyMatrix4(linkPose(hinges, link, opening)).toArray();

  it('leave the hinge where it is and the root alone', () => {
    for (const link of [1, 2])
      at(link, 0.3, [0, 0.001, 0.015]).forEach((x, k) => expect(x).toBeCloseTo([0, 0.001, 0.015][k]!, 12));
    expect(at(0, 0.3, [1, 2, 3])).toEqual([1, 2, 3]);
    expect(at(1, NaN, [1, 2, 3])).toEqual([1, 2, 3]);
  });

  it('open symmetrically by the angle, axes of any length', () => {
    const r = 0.015;
    const a = 0.2;
    const one = at(1, a, [0, 0, 0]);
    const two = at(2, a, [0, 0, 0]);
    expect(one[0]).toBeCloseTo(-r * Math.sin(a), 12);
    expect(one[2]).toBeCloseTo(r - r * Math.cos(a), 12);
    expect(two[0]).toBeCloseTo(r * Math.sin(a), 12);
    expect(two[2]).toBeCloseTo(one[2]!, 12);
  });
});
