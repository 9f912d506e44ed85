// SPDX-License-Identifier: GPL-3.0-or-later
// The guide leads nobody past a target at which something is still to be done.
import * as THREE from 'three';
import { beforeEach, describe, expect, it } from 'vitest';
import type { Bundle, GuidePose } from '../src/bundle_types';
import { Guide } from '../src/guide';
import { toCount } from '../src/guiding';
import type { RenderFrame } from '../src/lcm';
import { StyledPlaces } from '../src/styled_places';

const none = { button1: false, button2: false };
const q = new THREE.Quaternion();
const at = (x: number, y = 0, z = 0) => new THREE.Vector3(x, y, z);
const pose = (hand: 'left' | 'right', p: [number, number, number]): GuidePose => ({
  hand,
  timeS: 0,
  tool: 'pointer',
  command: '',
  argument: '',
  nearM: 0.003,
  nearRad: 0.26,
  p,
  q: [1, 0, 0, 0],
  ...none,
});

describe('a target with a place where something is to be done', () => {
  // As in the tasks: a way in to the place and out again; the left hand's place is 3 mm from the right hand's.
  const poses = [
    pose('right', [0.01, 0, 0.01]),
    pose('right', [0.01, 0, 0]),
    pose('right', [0.01, 0, 0.012]),
    pose('left', [0.007, 0, 0]),
  ];
  let guide: Guide;
  beforeEach(() => {
    guide = new Guide();
    guide.begin({ exercise: { guide: poses } } as unknown as Bundle);
    guide.see([at(0.01)]);
  });
  const right = (p: THREE.Vector3) => {
    guide.follow(1, p, q, none);
    return guide.target(1)!.at;
  };

  it('is not passed before that is done, however near the tip is', () => {
    expect(right(at(0.01, 0, 0.0101))).toBe(1);
    expect([right(at(0.01, 0.0028)), right(at(0.01)), right(at(0.01))]).toEqual([1, 1, 1]);
    guide.see([]);
    expect(right(at(0.01))).toBe(2);
  });

  it('is to be reached within a millimetre, the others as before', () => {
    expect([guide.stays(1), guide.nearM(1)]).toEqual([false, 0.003]);
    right(at(0.01, 0, 0.01));
    expect([guide.stays(1), guide.nearM(1)]).toEqual([true, 0.001]);
    guide.see([]);
    expect([guide.stays(1), guide.nearM(1)]).toEqual([false, 0.003]);
  });

  it('is the nearest one of both hands, and none is bound by a place far away', () => {
    guide.see([at(0.007)]);
    right(at(0.01, 0, 0.01));
    expect([guide.stays(0), guide.stays(1)]).toEqual([true, false]);
    guide.see([at(0.01, 0.004)]);
    expect(guide.stays(1)).toBe(false);
  });

  it('can be left by hand', () => {
    right(at(0.01, 0, 0.01));
    guide.step(1, 1);
    expect(guide.target(1)!.at).toBe(2);
  });
});

describe('what to do at such a target', () => {
  const on = { button1: true, button2: false };
  it('is to press what is to be pressed, then to stay, or to sweep an edge', () => {
    expect(toCount(on, none, false, false)).toBe('At the target: hold button 1 (Space)');
    expect(toCount(on, on, false, false)).toBe('');
    expect(toCount(on, on, true, false)).toBe('Stay here until the goal is ticked');
    expect(toCount(none, none, true, true)).toBe('Sweep the edge across it');
  });
  it('is to keep a button that the example lets go there', () => {
    expect(toCount(none, on, false, false)).toBe('');
    expect(toCount(none, on, true, false)).toBe('Stay here until the goal is ticked');
  });
});

describe('the places of a style', () => {
  const drawable = (index: number, kind: string, material: string, pointsPerLine = 1) => ({
    declared: { index, kind, material, pointsPerLine },
  });
  const bundle = {
    drawables: [
      drawable(0, 'points', 'done'),
      drawable(1, 'points', 'turn'),
      drawable(2, 'polylines', 'turn', 3),
      drawable(3, 'label', 'turn'),
    ],
    materials: new Map([
      ['done', { style: 'solid' }],
      ['turn', { style: 'place' }],
    ]),
  } as unknown as Bundle;
  const frame = (...data: number[][]) =>
    ({ drawable: data.map((d, index) => ({ index, data: new Float32Array(d) })) }) as unknown as RenderFrame;

  it('are its points and the middles of its lines, without lines that are gone', () => {
    const places = new StyledPlaces('place');
    places.begin(bundle);
    const line = (x: number, value: number) => [x, 0, 0, value, x + 1, 3, 0, value, x + 2, 0, 0, value];
    const seen = places.in(frame([9, 9, 9, 0], [1, 2, 3, 0], [...line(4, 1), ...line(8, -1)], [7, 7, 7, 1]));
    expect(seen.map((p) => p.toArray())).toEqual([
      [1, 2, 3],
      [5, 1, 0],
    ]);
  });
});
