// SPDX-License-Identifier: GPL-3.0-or-later
// The person of the browser test at a made-up page: reads the panel's lines, errs as people do, and gets there.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { offsetOf } from '../src/guide';
import { directions } from '../src/hud/guide_panel';
import { Person } from './human_hands.mjs';

const axes = { x: new THREE.Vector3(1, 0, 0), y: new THREE.Vector3(0, 1, 0), z: new THREE.Vector3(0, 0, 1) };
/** A hand that follows mouse and wheel, and a panel that says how far its target is. */
function madeUp(mPerPx: number, target: THREE.Vector3) {
  const p = new THREE.Vector3();
  let at: [number, number] | null = null;
  let shift = false;
  const view = () => {
    const offset = offsetOf(p, new THREE.Quaternion(), { p: target, q: new THREE.Quaternion() }, axes);
    const ways: Record<string, number> = {};
    // As the panel writes them: no more than four, nothing that is near, tenths of millimetres.
    for (const line of directions(offset, 0.003, 0.26).slice(0, 4)) {
      const [, name, mm] = /(\w+)(?: \(\w\))? ([\d.]+) mm$/.exec(line)!;
      ways[name!] = Number(mm);
    }
    return { target: { at: 1, of: 2, mm: 1000 * offset.distanceM, degrees: 0 }, ways, todo: '', hand: 1 };
  };
  const page = {
    viewportSize: () => ({ width: 640, height: 420 }),
    evaluate: () => Promise.resolve(view()),
    mouse: {
      move: (x: number, y: number) => {
        if (at) p.add(new THREE.Vector3((x - at[0]) * mPerPx, (at[1] - y) * mPerPx, 0));
        if (at) at = [x, y];
        else last = [x, y];
      },
      down: () => {
        at = last;
      },
      up: () => {
        at = null;
      },
      wheel: (_: number, dy: number) => {
        if (shift) p.z += 0.0008 * (dy / 100);
      },
    },
    keyboard: {
      down: (key: string) => {
        shift ||= key === 'Shift';
      },
      up: (key: string) => {
        if (key === 'Shift') shift = false;
      },
    },
  };
  let last: [number, number] = [0, 0];
  return { page, view };
}

describe('a person with errors of 2 mm', () => {
  const target = new THREE.Vector3(0.018, -0.011, -0.014);

  it.each([1, 2, 3, 4, 5, 6, 7, 8, 9, 10])('reaches a target that is only described, seed %i', async (seed) => {
    // The mouse is half as quick as the person believes at first.
    const { page, view } = madeUp(0.00005, target);
    const person = new Person(page, seed, 0);
    let tries = 0;
    for (let now = await person.look(); now.target.mm > 3 && tries < 12; tries++) now = await person.reach(now);
    expect(view().target.mm).toBeLessThanOrEqual(3);
    expect(tries).toBeGreaterThan(1);
  });

  it('errs by 2 mm in the root of the mean square, differently for each seed, and alike for the same one', () => {
    const aims = (seed: number) => {
      const person = new Person(null, seed, 0);
      return Array.from({ length: 4000 }, () => Math.hypot(...person.aim()));
    };
    const first = aims(1);
    expect(Math.sqrt(first.reduce((s, e) => s + e * e, 0) / first.length)).toBeCloseTo(0.002, 4);
    expect(aims(1)).toEqual(first);
    expect(aims(2)).not.toEqual(first);
  });
});
