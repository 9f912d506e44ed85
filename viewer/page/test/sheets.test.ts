// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of membrane: where the tip of a tent stands over its piece, and what the mesh of the pieces is given as they
// tent, tear, lose their fibres and shrink.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { Sheets } from '../src/drawables/sheets';
import { tentOf } from '../src/drawables/tent';
import { FieldUniforms } from '../src/materials/field';
import { parseDrawables } from '../src/step_data/declarations';

type Place = [number, number, number];

/** Twisted, about 4 mm by 3 mm. */
const corners = [0, 0, 0, 0, 0.003, 0.0004, 0.004, 0, 0.0007, 0.0035, 0.0032, -0.0004];
const at = (s: number, t: number): Place =>
  [0, 1, 2].map(
    (k) =>
      (1 - s) * ((1 - t) * corners[k]! + t * corners[3 + k]!) + s * ((1 - t) * corners[6 + k]! + t * corners[9 + k]!),
  ) as Place;
const normal = (s: number, t: number): THREE.Vector3 => {
  const d = (a: Place, b: Place) => new THREE.Vector3(...b).sub(new THREE.Vector3(...a));
  return d(at(s, t), at(s + 0.001, t)).cross(d(at(s, t), at(s, t + 0.001))).normalize(); // prettier-ignore
};

describe('a tent', () => {
  it('stands at the foot of its tip and is as high as this', () => {
    for (const [s, t, z] of [
      [0.2, 0.6, 0.0012],
      [0.5, 0.5, -0.0008],
      [0.9, 0.15, 0.0003],
    ] as const) {
      // prettier-ignore
      const n = normal(s, t);
      const tip = new THREE.Vector3(...at(s, t)).addScaledVector(n, z);
      const tent = tentOf(corners, tip.toArray());
      expect(tent.s).toBeCloseTo(s, 3);
      expect(tent.t).toBeCloseTo(t, 3);
      expect(new THREE.Vector3(...tent.rise).dot(n)).toBeCloseTo(z, 7);
    }
  });

  it('is none on the piece itself, and beside a piece it leans out from its edge', () => {
    expect(Math.hypot(...tentOf(corners, at(0.3, 0.7)).rise)).toBeLessThan(1e-9);
    const beside = tentOf(corners, [-0.001, 0.0015, 0.0005]);
    expect(beside.s).toBe(0);
    expect(beside.rise[0]).toBeCloseTo(-0.001, 4);
  });
});

describe('pieces of membrane', () => {
  const declared = parseDrawables([
    { id: 'm.sheets', kind: 'polylines', material: 'film', points_per_line: 5, count: 1, index: 0 },
  ])[0]!;
  const material = { style: 'sheet', rgba: [1, 1, 1, 0.8] as [number, number, number, number], roughness: 0.3 };
  const make = () =>
    new Sheets({
      declared,
      material: { ...material, metalness: 0, translucency: 0.5 },
      meshes: [],
      field: new FieldUniforms(),
      environment: null,
      veils: false,
    });
  const line = (tip: Place, whole: number, first = 1, second = 1): Float32Array => {
    const [a, b, c, d] = [0, 1, 2, 3].map((k) => corners.slice(3 * k, 3 * k + 3));
    return Float32Array.from([...tip, whole, ...a!, first, ...b!, first, ...c!, second, ...d!, second]);
  };
  const geometry = (s: Sheets) => s.root.geometry as THREE.InstancedBufferGeometry;
  const numbers = (s: Sheets, name: string) => [...(geometry(s).getAttribute(name).array as Float32Array)];
  const show = (s: Sheets, data: Float32Array, seconds: number) => s.update(data, { dt: 0.016, seconds });
  const tip = new THREE.Vector3(...at(0.3, 0.6)).addScaledVector(normal(0.3, 0.6), 0.001).toArray() as Place;

  it('are spanned between the ends and tent to the tip', () => {
    const s = make();
    show(s, line(tip, 0.5, 1, 0.8), 1);
    expect(geometry(s).instanceCount).toBe(1);
    expect(numbers(s, 'j_to')[0]).toBeCloseTo(0.0035, 9);
    const [foot, along, torn, depth] = numbers(s, 'tent');
    expect(foot).toBeCloseTo(0.3, 3);
    expect(along).toBeCloseTo(0.6, 3);
    expect(torn).toBe(-1);
    expect(depth).toBeCloseTo(0.001, 6);
    expect(Math.hypot(...numbers(s, 'rise'))).toBeCloseTo(0.001, 6);
    [0.5, 0.4, -1, -1].forEach((x, k) => expect(numbers(s, 'state')[k]).toBeCloseTo(x, 6));
    show(s, line(at(0.5, 0.5), 1), 1.1);
    expect(numbers(s, 'tent')[3]).toBeLessThan(1e-6);
  });

  it('tear open from where the tip was, and a fringe stays while a fibre stands', () => {
    const s = make();
    show(s, line(tip, 1), 1);
    show(s, line(at(0.5, 0.5), -1), 2);
    show(s, line(at(0.5, 0.5), -1), 2.5);
    const [foot, along, torn, depth] = numbers(s, 'tent');
    expect(foot).toBeCloseTo(0.3, 3);
    expect(along).toBeCloseTo(0.6, 3);
    expect(torn).toBeCloseTo(0.5, 6);
    expect(depth).toBe(0);
    show(s, line(at(0.5, 0.5), -1), 100);
    expect(geometry(s).instanceCount).toBe(1);
  });

  it('shrink when both fibres have parted, and go; a reset brings them back', () => {
    const s = make();
    show(s, line(at(0.5, 0.5), 1), 1);
    show(s, line(at(0.5, 0.5), 1, -1), 2);
    expect(numbers(s, 'state').slice(2)).toEqual([0, -1]);
    show(s, line(at(0.5, 0.5), -1, -1, -1), 3);
    expect(geometry(s).instanceCount).toBe(1);
    show(s, line(at(0.5, 0.5), -1, -1, -1), 40);
    expect(geometry(s).instanceCount).toBe(0);
    show(s, line(at(0.5, 0.5), 1), 41);
    expect(geometry(s).instanceCount).toBe(1);
    expect(numbers(s, 'tent')[2]).toBe(-1);
  });

  it('are not there for a page that comes after they have parted', () => {
    const s = make();
    show(s, line(at(0.5, 0.5), -1, -1, -1), 5);
    expect(geometry(s).instanceCount).toBe(0);
  });
});
