// SPDX-License-Identifier: GPL-3.0-or-later
// Geometry of the two eyes, by projecting points: no parallax at the focus, the known one before and behind it.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { anaglyphLeft, anaglyphRight, eyeSeparation, placeEye } from '../src/stereo';
import { clampAngle } from '../src/stereo_modes';

const focus = 0.25;
const angle = (5 * Math.PI) / 180;
const aspect = 1.6;

function eyes() {
  const middle = new THREE.PerspectiveCamera(20, aspect, 0.05, 1);
  middle.position.set(0.3, -0.2, 0.5);
  middle.up.set(0, 0, 1);
  const direction = new THREE.Vector3(-0.6, 0.5, -0.7).normalize();
  middle.lookAt(middle.position.clone().add(direction));
  middle.updateMatrixWorld();
  middle.updateProjectionMatrix();
  const pair = ([-1, 1] as const).map((side) => {
    const c = new THREE.PerspectiveCamera();
    placeEye(middle, side, focus, angle, aspect, c);
    return c;
  });
  const right = new THREE.Vector3().setFromMatrixColumn(middle.matrixWorld, 0);
  const at = (depth: number, across = 0) =>
    middle.position.clone().addScaledVector(direction, depth).addScaledVector(right, across);
  return { middle, left: pair[0]!, right: pair[1]!, at };
}

describe('stereo', () => {
  it('has the separation that its angle says: 22 mm at 250 mm for 5 degrees', () => {
    expect(eyeSeparation(focus, angle)).toBeCloseTo(0.021831, 5);
    const e = eyes();
    expect(e.left.position.distanceTo(e.right.position)).toBeCloseTo(eyeSeparation(focus, angle), 12);
    expect(
      e.left.position.clone().add(e.right.position).multiplyScalar(0.5).distanceTo(e.middle.position),
    ).toBeLessThan(1e-12);
  });

  it('shows the plane of focus at the same place to both eyes and to one', () => {
    const e = eyes();
    for (const across of [-0.03, 0, 0.02]) {
      const p = e.at(focus, across);
      const [l, r, m] = [e.left, e.right, e.middle].map((c) => p.clone().project(c));
      expect(l!.x).toBeCloseTo(m!.x, 9);
      expect(r!.x).toBeCloseTo(m!.x, 9);
      expect(l!.y).toBeCloseTo(m!.y, 9);
    }
  });

  it.each([0.2, 0.24, 0.3])('has the parallax s (1/d - 1/f) at distance %d', (d) => {
    const e = eyes();
    const halfWide = Math.tan((10 * Math.PI) / 180) * aspect;
    const parallax = e.at(d).project(e.left).x - e.at(d).project(e.right).x;
    expect(parallax).toBeCloseTo((eyeSeparation(focus, angle) * (1 / d - 1 / focus)) / halfWide, 9);
    expect(Math.sign(parallax)).toBe(d < focus ? 1 : -1);
  });

  it('can be undone: unproject finds the point again', () => {
    const e = eyes();
    const p = e.at(0.22, 0.01);
    for (const c of [e.left, e.right]) expect(p.clone().project(c).unproject(c).distanceTo(p)).toBeLessThan(1e-9);
  });

  it('keeps the angle in its range', () => {
    expect([0, 4.5, 50, NaN].map(clampAngle)).toEqual([1, 4.5, 9, 5]);
  });

  it('gives red to the left eye, green and blue to the right, and white back for white', () => {
    const white = (m: readonly number[]) =>
      [0, 1, 2].map((row) => Math.max(0, m[row * 3]! + m[row * 3 + 1]! + m[row * 3 + 2]!));
    const l = white(anaglyphLeft);
    const r = white(anaglyphRight);
    for (let k = 0; k < 3; k++) expect(l[k]! + r[k]!).toBeGreaterThan(0.95);
    expect(l[0]).toBeGreaterThan(1);
    expect(l[1]! + l[2]! + r[0]!).toBe(0);
  });
});
