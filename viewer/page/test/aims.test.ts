// SPDX-License-Identifier: GPL-3.0-or-later
// What is left over at the end of an example: the nearest place first, kept while it moves, passed over by hand.
import * as THREE from 'three';
import { beforeEach, describe, expect, it } from 'vitest';
import { Aims } from '../src/aims';
import type { Bundle } from '../src/bundle_types';
import type { RenderFrame } from '../src/lcm';

const point = (index: number, material: string) => ({
  declared: { index, kind: 'points', material, radiusM: 0.00025, pointsPerLine: 1 },
});
const bundle = {
  drawables: [point(0, 'steel'), point(3, 'aim')],
  materials: new Map([
    ['steel', { style: 'solid' }],
    ['aim', { style: 'aim', rgba: [0.4, 1, 0.8, 0.6] }],
  ]),
} as unknown as Bundle;
const frame = (...x: number[]) =>
  ({
    drawable: [
      { index: 0, data: new Float32Array([9, 9, 9, 1]) },
      { index: 3, data: new Float32Array(x.flatMap((v) => [v, 0, 0, 1])) },
    ],
  }) as unknown as RenderFrame;
const tip = new THREE.Vector3(0.001, 0, 0);

describe('the places of an aim', () => {
  let aims: Aims;
  const chosen = (...x: number[]) => aims.choose(aims.places(frame(...x)), tip)?.x ?? null;
  beforeEach(() => {
    aims = new Aims();
    aims.begin(bundle);
  });

  it('are those of its material, without what is no number', () => {
    expect(aims.places(frame(0.01, NaN, 0.02)).map((p) => p.x)).toEqual([0.01, 0.02].map((x) => expect.closeTo(x, 7)));
    expect(aims.places(frame())).toEqual([]);
  });

  it('lead to the nearest one, and stay with it while it moves', () => {
    expect(chosen(0.01, 0.02)).toBeCloseTo(0.01);
    expect(chosen(0.0112, 0.002)).toBeCloseTo(0.0112);
    expect(chosen(0.02)).toBeCloseTo(0.02); // it has gone
    expect(chosen()).toBeNull();
  });

  it('can be passed over, until all have been', () => {
    chosen(0.01, 0.02);
    aims.passOver();
    expect(chosen(0.01, 0.02)).toBeCloseTo(0.02);
    aims.passOver();
    expect(chosen(0.01, 0.02)).toBeCloseTo(0.01);
  });

  it('are marked', () => {
    aims.show(aims.places(frame(0.01, 0.02)));
    expect(aims.root.children.map((m) => m.visible)).toEqual([true, true]);
    expect(aims.root.children.map((m) => m.scale.x)).toEqual([0.00025, 0.00025]);
    aims.show(aims.places(frame(0.01)));
    expect(aims.root.children.map((m) => m.visible)).toEqual([true, false]);
  });
});
