// SPDX-License-Identifier: GPL-3.0-or-later
// Automatic quality: down when slow, up when idle, without swinging; and hands that take over without a jump.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { HandPose } from '../src/hand_pose';
import { levels, QualityWatch } from '../src/quality';

describe('quality', () => {
  it('steps down after two slow seconds, to the lowest', () => {
    const w = new QualityWatch(null);
    const from = w.level;
    expect(w.observe(20, 1)).toBe(false);
    expect(w.observe(20, 1)).toBe(true);
    expect(w.level).toBe(from - 1);
    for (let k = 0; k < 20; k++) w.observe(5, 1);
    expect(w.level).toBe(0);
  });

  it('does not react to one slow second, nor to a fixed level', () => {
    const w = new QualityWatch(null);
    for (let k = 0; k < 20; k++) w.observe(k % 2 ? 20 : 50, 1);
    expect(levels[w.level]!.name).toBe('high');
    const fixed = new QualityWatch('ultra');
    for (let k = 0; k < 20; k++) expect(fixed.observe(3, 1)).toBe(false);
  });

  it('raises only after a long good time, and never by itself to the level with depth of field', () => {
    const w = new QualityWatch(null);
    w.observe(10, 1);
    w.observe(10, 1);
    const low = w.level;
    for (let k = 0; k < 30; k++) w.observe(60, 1);
    expect(w.level).toBe(low);
    for (let k = 0; k < 300; k++) w.observe(60, 1);
    expect(levels[w.level]!.name).toBe('high');
  });
});

describe('hand pose', () => {
  it('starts where the tool is and keeps its own pose afterwards', () => {
    const h = new HandPose();
    h.take(new THREE.Vector3(1, 2, 3), new THREE.Quaternion(0, 0, 2, 0));
    expect(h.p.toArray()).toEqual([1, 2, 3]);
    expect(h.q.toArray()).toEqual([0, 0, 1, 0]);
    h.take(new THREE.Vector3(9, 9, 9), new THREE.Quaternion());
    expect(h.p.toArray()).toEqual([1, 2, 3]);
    h.release();
    expect(h.taken).toBe(false);
  });

  it('stays within reach of the field and turns about the tip', () => {
    const h = new HandPose();
    h.take(new THREE.Vector3(), new THREE.Quaternion());
    h.move(new THREE.Vector3(5, 0, 0), new THREE.Vector3());
    expect(h.p.length()).toBeCloseTo(0.12, 12);
    const p = h.p.toArray();
    h.turn(new THREE.Vector3(0, 1, 0), Math.PI / 2);
    expect(h.p.toArray()).toEqual(p);
    const z = new THREE.Vector3(0, 0, 1).applyQuaternion(h.q);
    expect(z.x).toBeCloseTo(1, 12);
  });
});
