// SPDX-License-Identifier: GPL-3.0-or-later
// The skinning law against affine maps, for which it must be exact, and the blend between frames.
import { describe, expect, it } from 'vitest';
import * as lcm from '../src/lcm';
import { Playback } from '../src/playback';
import { barycentric, NodeField, skinVertex } from '../src/skinning';

// Two tetrahedra with a common face, the second numbered the other way round (negative volume).
const rest = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1]);
const quads = Uint32Array.from([0, 1, 2, 3, 4, 1, 2, 3]);
const normal = [1 / 3, 2 / 3, 2 / 3];

type Matrix = number[]; // 3x3 by rows

function apply(affine: Matrix, b: number[], x: ArrayLike<number>): number[] {
  return [0, 1, 2].map((i) => affine[3 * i]! * x[0]! + affine[3 * i + 1]! * x[1]! + affine[3 * i + 2]! * x[2]! + b[i]!);
}

function cofactor(affine: Matrix): Matrix {
  const a = (i: number, j: number) => affine[3 * ((i + 3) % 3) + ((j + 3) % 3)]!;
  return Array.from({ length: 9 }, (_, k) => {
    const i = Math.floor(k / 3);
    const j = k % 3;
    return a(i + 1, j + 1) * a(i + 2, j + 2) - a(i + 1, j + 2) * a(i + 2, j + 1);
  });
}

function move(affine: Matrix, b: number[]): Float32Array {
  const out = new Float32Array(rest.length);
  for (let i = 0; i < rest.length; i += 3) out.set(apply(affine, b, rest.subarray(i, i + 3)), i);
  return out;
}

const unit = (v: number[]) => v.map((x) => x / Math.hypot(...v));

describe('skinning', () => {
  const cases: [string, Matrix, number[]][] = [
    ['rest', [1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0]],
    ['rigid', [0, -1, 0, 1, 0, 0, 0, 0, 1], [3, -2, 5]],
    ['stretch', [2, 0, 0, 0, 1, 0, 0, 0, 0.5], [0, 0, 0]],
    ['shear and stretch', [1.2, 0.4, -0.1, 0.05, 0.9, 0.3, -0.2, 0.1, 1.1], [0.1, 0.2, 0.3]],
  ];
  it.each(cases)('%s: positions are the map, normals its cofactor', (_, affine, b) => {
    const field = new NodeField(rest, [quads]);
    field.update(move(affine, b));
    const point = [0.9, 0.7, 0.6];
    for (const t of [0, 1]) {
      const w = barycentric(rest, quads, t * 4, point)!;
      const x: number[] = [];
      const n: number[] = [];
      skinVertex(field, quads.subarray(t * 4, t * 4 + 4), w, 0, normal, x, n);
      const wanted = apply(affine, b, point);
      const wantedN = unit(apply(cofactor(affine), [0, 0, 0], normal));
      for (let k = 0; k < 3; k++) {
        expect(x[k]).toBeCloseTo(wanted[k]!, 5);
        expect(n[k]).toBeCloseTo(wantedN[k]!, 5);
      }
    }
  });

  it('gives weights that sum to one and reproduce the point, inside and outside', () => {
    for (const p of [
      [0.2, 0.2, 0.2],
      [2, -1, 0.5],
    ]) {
      const w = barycentric(rest, quads, 4, p)!;
      expect(w[0] + w[1] + w[2] + w[3]).toBeCloseTo(1, 12);
      for (let j = 0; j < 3; j++)
        expect([0, 1, 2, 3].reduce((s, k) => s + w[k]! * rest[quads[4 + k]! * 3 + j]!, 0)).toBeCloseTo(p[j]!, 10);
    }
  });

  it('leaves out flat tetrahedra and still gives unit normals', () => {
    const flat = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0]);
    expect(barycentric(flat, [0, 1, 2, 3], 0, [0, 0, 1])).toBeNull();
    const field = new NodeField(flat, [Uint32Array.from([0, 1, 2, 3])]);
    const x: number[] = [];
    const n: number[] = [];
    skinVertex(field, [0, 1, 2, 3], [0.25, 0.25, 0.25, 0.25], 0, normal, x, n);
    expect(Math.hypot(...n)).toBeCloseTo(1, 6);
    expect(x[0]).toBeCloseTo(0.5, 6);
  });
});

describe('playback', () => {
  const frame = (sequence: bigint, value: number, session = 1n) => {
    const f = lcm.render_frame_t.make();
    Object.assign(f, {
      session,
      sequence,
      bodies: 1,
      body: [{ index: 0, nodes: 1, x_m: Float32Array.from([value, 0, 0]) }],
    });
    return f;
  };

  it('moves from the previous frame to the newest within a period', () => {
    const p = new Playback();
    p.push(frame(1n, 0), 0);
    p.push(frame(2n, 10), 1000 / 60);
    const at = (ms: number) => p.nodes(0, p.blend(1000 / 60 + ms))![0]!;
    expect(at(0)).toBe(0);
    expect(at(1000 / 120)).toBeCloseTo(5, 1);
    expect(at(1000)).toBe(10);
  });

  it('never blends across sessions or restarts', () => {
    const p = new Playback();
    p.push(frame(5n, 0), 0);
    p.push(frame(6n, 10, 2n), 16);
    expect(p.nodes(0, 0)![0]).toBe(10);
    p.push(frame(0n, 20, 2n), 32);
    expect(p.nodes(0, 0)![0]).toBe(20);
    expect(p.nodes(3, 0)).toBeNull();
  });
});
