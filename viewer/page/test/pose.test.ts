// SPDX-License-Identifier: GPL-3.0-or-later
// The place of a vessel in the fissure: poses and their numbers, and one question at a time.
import { Quaternion, Vector3 } from 'three';
import { expect, test } from 'vitest';
import type { Point } from '../src/studio/api';
import {
  placedAt,
  PoseAsker,
  poseFrom,
  type PoseState,
  poseStateOf,
  type Question,
  samePose,
} from '../src/studio/pose/pose';

test('a pose is a shift and a rotation vector', () => {
  const at = placedAt([1, 2, 3, 0, 0, 90], [1, 0, 0]);
  expect(at.distanceTo(new Vector3(1, 3, 3))).toBeLessThan(1e-12);
});

test('a pose comes back from the turn and the place of a point, to what is written of it', () => {
  const neck: Point = [30, -20, 55];
  for (const pose of [
    [4, -5, 6, 20, -30, 40],
    [0, 0, 0, 0, 0, 0],
    [-1, 2, 3, 0, 179, 0],
  ]) {
    const turned = new Quaternion().setFromAxisAngle(
      new Vector3(...pose.slice(3)).normalize(),
      new Vector3(...pose.slice(3)).length() * (Math.PI / 180),
    );
    const found = poseFrom(turned, neck, placedAt(pose, neck));
    found.forEach((x, k) => expect(x).toBeCloseTo(pose[k]!, 2));
    // What is rounded of the turn is made up for by the shift: the point lies where it was put.
    expect(placedAt(found, neck).distanceTo(placedAt(pose, neck))).toBeLessThan(1e-3);
    expect(samePose(found, pose)).toBe(true);
  }
  expect(samePose([0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0.1])).toBe(false);
});

test('a state of the gateway is read, and an empty one', () => {
  expect(poseStateOf({ state: 'starting', error: '', busy: false, facts: null, answer: null }).facts).toBeNull();
  const answer = {
    pose: [1, 2, 3, 4, 5, 6],
    parted: true,
    overlap_mm: { frontal: 1.5, insula: 0 },
    seen_pct: 75,
    hidden_pct: { vessel: 25 },
  };
  const read = poseStateOf({ state: 'ready', facts: {}, answer }).answer!;
  expect(read.overlapMm).toEqual([
    ['frontal', 1.5],
    ['insula', 0],
  ]);
  expect([read.seenPct, read.hiddenPct]).toEqual([75, [['vessel', 25]]]);
});

test('of many places while one is answered, only the last is asked for', async () => {
  const asked: (Question | null)[] = [];
  const told: PoseState[] = [];
  const ready = poseStateOf({ state: 'ready' });
  const asker = new PoseAsker(
    (q) => {
      asked.push(q);
      return Promise.resolve({ ...ready, busy: asked.length === 1 });
    },
    (s) => told.push(s),
    () => expect.fail(),
  );
  for (let k = 0; k < 9; k++) asker.want({ pose: [k, 0, 0, 0, 0, 0], parted: false });
  await expect.poll(() => told.length).toBe(2);
  expect(asked.map((q) => q?.pose[0])).toEqual([0, 8]);
});
