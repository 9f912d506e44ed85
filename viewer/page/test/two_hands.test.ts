// SPDX-License-Identifier: GPL-3.0-or-later
// Two hands with one mouse: one is held where it is while the other one moves, a wrist is turned to its target, and an
// exchange of tools is undone.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import type { Button } from '../src/hand_pose';
import { assistRadPerS, Hands } from '../src/hands';
import { ToolHistory } from '../src/hud/tool_history';

interface Sent {
  hand: number;
  p_m: Float64Array;
  q: Float64Array;
  button1: boolean;
  button2: boolean;
}

/** Hands without a page: tools stand at known places, and what would be sent is kept. */
function bench(wanted: THREE.Quaternion | null = null) {
  const sent: Sent[] = [];
  const commands: string[] = [];
  const axes = () => ({
    x: new THREE.Vector3(1, 0, 0),
    y: new THREE.Vector3(0, 1, 0),
    z: new THREE.Vector3(0, 0, 1),
  });
  const hands = new Hands(
    { axes, homeTarget: new THREE.Vector3() },
    {
      sendHand: (m) => sent.push(m as Sent),
      sendCommand: (c, a = '') => commands.push(`${c} ${a}`),
    },
    {
      toolPose: (hand) => ({ p: new THREE.Vector3(hand ? 0.01 : -0.01, 0, 0), q: new THREE.Quaternion() }),
      wanted: () => wanted,
    },
    () => undefined,
    true,
  );
  let now = 0;
  const step = (dt = 0.02): Sent[] => {
    sent.length = 0;
    now += 1000 * dt;
    hands.update(dt, now);
    return [...sent];
  };
  return { hands, commands, step };
}

describe('hold here', () => {
  it('keeps the hand with its button where it is, and takes the other one', () => {
    const { hands, step } = bench();
    hands.move({ right: 0.003, out: -0.002 });
    hands.press(1, true);
    hands.holdHere();
    expect(hands.active).toBe(0);
    expect(hands.view().map((h) => [h.taken, h.resting])).toEqual([
      [true, false],
      [true, true],
    ]);
    hands.press(1 as Button, false); // of the other hand: nothing was on
    hands.move({ up: 0.004 });
    const [left, right] = step();
    expect([...left!.p_m]).toEqual([-0.01, 0.004, 0]);
    expect([...right!.p_m]).toEqual([0.01 + 0.003, 0, -0.002]);
    expect([left!.button1, right!.button1]).toEqual([false, true]);
  });

  it('lets nothing move the held hand, and gives it over without a jump', () => {
    const { hands, step } = bench();
    hands.move({ right: 0.003 });
    hands.turn({ roll: 0.4 });
    const before = step().find((m) => m.hand === 1)!;
    hands.holdHere();
    hands.move({ right: 0.05 }, 1);
    hands.turn({ roll: 1 }, 1);
    step();
    hands.setActive(1);
    const after = step().find((m) => m.hand === 1)!;
    expect([...after.p_m]).toEqual([...before.p_m]);
    expect([...after.q]).toEqual([...before.q]);
    expect(hands.view()[1]!.resting).toBe(false);
    hands.move({ right: 0.001 });
    expect(step().find((m) => m.hand === 1)!.p_m[0]! - before.p_m[0]!).toBeCloseTo(0.001, 12);
  });

  it('ends when the hand is given back', () => {
    const { hands, commands } = bench();
    hands.holdHere();
    hands.release(1);
    expect(commands).toEqual(['release right']);
    expect(hands.view()[1]).toMatchObject({ taken: false, resting: false });
  });

  it('does nothing for who may not drive', () => {
    const hands = new Hands(
      { axes: () => ({}) as never, homeTarget: new THREE.Vector3() },
      { sendHand: () => undefined, sendCommand: () => undefined },
      { toolPose: () => ({ p: new THREE.Vector3(), q: new THREE.Quaternion() }), wanted: () => null },
      () => undefined,
      false,
    );
    hands.holdHere();
    expect([hands.active, hands.view()[1]!.taken]).toEqual([1, false]);
  });
});

describe('help for the wrist', () => {
  const wanted = new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(1, 2, 2).normalize(), 0.3);
  const turned = (m: Sent) => new THREE.Quaternion(m.q[1], m.q[2], m.q[3], m.q[0]);

  it('turns it at a limited rate about the tip, and ends at the target', () => {
    const { hands, step } = bench(wanted);
    hands.toggleAssist();
    expect(hands.assisted).toBe(1);
    let left = 0.3;
    let steps = 0;
    while (hands.assisted >= 0 && steps < 100) {
      const [m] = step();
      const now = turned(m!).angleTo(wanted);
      expect(left - now).toBeLessThan(assistRadPerS * 0.02 + 1e-6);
      expect([...m!.p_m]).toEqual([0.01, 0, 0]);
      left = now;
      steps++;
    }
    expect(left).toBeLessThan(1e-6);
    expect(steps).toBe(Math.ceil(0.3 / (assistRadPerS * 0.02)));
  });

  it('ends when the user turns the wrist or goes to the other hand, but not when the tool is moved', () => {
    const { hands, step } = bench(wanted);
    hands.toggleAssist();
    hands.move({ right: 0.001 });
    step();
    expect(hands.assisted).toBe(1);
    hands.turn({ roll: 0.01 });
    expect(hands.assisted).toBe(-1);
    hands.toggleAssist();
    hands.setActive(0);
    expect(hands.assisted).toBe(-1);
    hands.toggleAssist();
    hands.toggleAssist();
    expect(hands.assisted).toBe(-1);
  });

  it('is not there without a target', () => {
    const { hands } = bench(null);
    hands.toggleAssist();
    expect([hands.assisted, hands.view()[1]!.taken]).toEqual([-1, false]);
  });
});

describe('undo of an exchange', () => {
  it('leads to the tool before, and back', () => {
    const h = new ToolHistory();
    h.see('suction');
    expect(h.before).toBe('');
    h.see('');
    h.see('probe');
    h.see('probe');
    expect([h.held, h.before]).toEqual(['probe', 'suction']);
    h.see('suction');
    expect(h.before).toBe('probe');
    h.forget();
    h.see('suction');
    expect(h.before).toBe('');
  });
});
