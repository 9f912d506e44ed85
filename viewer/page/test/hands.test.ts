// SPDX-License-Identifier: GPL-3.0-or-later
// Hands on a flat screen: latches, keys by their labels, two fingers, and the way to a target.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { TwoFingers } from '../src/gestures';
import { Guide, offsetOf } from '../src/guide';
import { buttonsToDo, toChoose } from '../src/guiding';
import { HandPose } from '../src/hand_pose';
import { directions } from '../src/hud/guide_panel';
import { timesText, verdict } from '../src/hud/summary';
import { keyOf } from '../src/keyboard';
import { adviceFor } from '../src/software_rendering';
import type { Bundle, GuidePose } from '../src/bundle_types';
import type { RenderFrame } from '../src/lcm';

describe('a latch', () => {
  it('keeps what is held when the keys go to the other hand, and lets go on purpose only', () => {
    const h = new HandPose();
    h.hold(1, true);
    h.latchHeld();
    expect([h.button1, h.latched(1), h.button2]).toEqual([true, true, false]);
    h.hold(1, false); // the key goes up over there
    h.letGoHeld(); // the window loses the keys
    expect(h.button1).toBe(true);
    h.latch(1, false);
    expect(h.button1).toBe(false);
    h.latch(2, true);
    h.release();
    expect([h.button2, h.taken]).toEqual([false, false]);
  });
});

describe('keys', () => {
  it('are those that stand on the keyboard', () => {
    expect(keyOf({ key: 'a', code: 'KeyQ' })).toBe('a'); // AZERTY
    expect(keyOf({ key: 'Y', code: 'KeyZ' })).toBe('y'); // QWERTZ with Shift
    expect(keyOf({ key: '[', code: 'Digit8' })).toBe('[');
    expect(keyOf({ key: '?', code: 'Minus' })).toBe('?');
    expect(keyOf({ key: ' ', code: 'Space' })).toBe('space');
    expect(keyOf({ key: 'ArrowLeft', code: 'ArrowLeft' })).toBe('arrowleft');
  });
  it('are those of the place where there are no Latin letters or no plain digits', () => {
    expect(keyOf({ key: 'п', code: 'KeyG' })).toBe('g');
    expect(keyOf({ key: '&', code: 'Digit1' })).toBe('1');
    expect(keyOf({ key: 'Enter', code: 'Enter' })).toBe('enter');
  });
});

describe('two fingers', () => {
  const steps = (way: [number, number, number, number][]) => {
    const f = new TwoFingers();
    return way.map(([ax, ay, bx, by]) => f.move({ x: ax, y: ay }, { x: bx, y: by })).filter((s) => s !== null);
  };
  it('keep to what they began', () => {
    const depth = steps([
      [0, 0, 100, 0],
      [0, 20, 100, 20],
      [0, 50, 160, 50],
    ]);
    expect(depth.map((s) => s.kind)).toEqual(['depth', 'depth']);
    expect(depth[1]!.by).toBe(30);
  });
  it('turn, zoom and swing', () => {
    const roll = steps([
      [0, 0, 100, 0],
      [0, 0, Math.cos(0.3) * 100, Math.sin(0.3) * 100],
    ]);
    expect(roll).toEqual([{ kind: 'roll', by: expect.closeTo(0.3, 9) as number }]);
    const zoom = steps([
      [0, 0, 100, 0],
      [-50, 0, 150, 0],
    ]);
    expect(zoom).toEqual([{ kind: 'zoom', by: 2 }]);
    const swing = steps([
      [0, 0, 100, 0],
      [25, 0, 125, 0],
    ]);
    expect(swing[0]!.kind).toBe('swing');
  });
});

describe('the guide', () => {
  const axes = { x: new THREE.Vector3(1, 0, 0), y: new THREE.Vector3(0, 1, 0), z: new THREE.Vector3(0, 0, 1) };
  const pose = (p: [number, number, number], button1 = false): GuidePose => ({
    hand: 'right',
    timeS: 0,
    tool: 'applier',
    command: '',
    argument: '',
    nearM: 0.003,
    nearRad: 0.26,
    p,
    q: [1, 0, 0, 0],
    button1,
    button2: false,
  });
  const none = { button1: false, button2: false };
  const at = (x: number) => new THREE.Vector3(x, 0, 0);
  const q = new THREE.Quaternion();

  it('says how far it is, and what the wrist must do', () => {
    const target = {
      p: new THREE.Vector3(0.01, -0.02, 0.004),
      q: new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(0, 0, 1), 0.8),
    };
    const o = offsetOf(at(0), q, target, axes);
    expect(o.right).toBeCloseTo(0.01, 12);
    expect(o.up).toBeCloseTo(-0.02, 12);
    expect(o.out).toBeCloseTo(0.004, 12);
    expect([o.roll, o.turn, o.tilt]).toEqual([0.8, 0, 0].map((x) => expect.closeTo(x, 9) as number));
    expect(directions(o, 0.003, 0.26)[0]).toBe('↓ down 20.0 mm');
    expect(directions(o, 0.003, 0.26)).toContain('↻ roll (E) 46°');
    // Carrying the turns out leads to the target.
    const turned = q.clone().premultiply(new THREE.Quaternion().setFromAxisAngle(axes.z, o.roll));
    expect(turned.angleTo(target.q)).toBeCloseTo(0, 6);
  });

  it('says what the example has chosen from the list, until it is off the tray', () => {
    const tool = (id: string, kind: string, index: number, hand: string) => ({ id, kind, index, hand, title: id });
    const bundle = {
      tools: [tool('applier', 'clip_applier', 0, 'right'), tool('short', 'clip', 1, ''), tool('long', 'clip', 2, '')],
      commands: [{ id: 'applier', element: 'clip_applier', commands: [{ name: 'load', argument: 'clip id' }] }],
    } as unknown as Bundle;
    const lying = (...state: number[]) => ({ tool: state.map((s, index) => ({ index, state: s })) }) as RenderFrame;
    const target = { tool: 'applier', command: 'load', argument: 'long' };
    expect(toChoose(target, lying(1, 0, 0), bundle)?.id).toBe('long');
    expect(toChoose(target, lying(1, 0, 1), bundle)).toBeNull();
    expect(toChoose(target, lying(1, 0, 2), bundle)).toBeNull();
    expect(toChoose({ ...target, command: '' }, lying(1, 0, 0), bundle)).toBeNull();
    expect(toChoose({ ...target, argument: 'none' }, lying(1, 0, 0), bundle)).toBeNull();
  });

  it('counts a target as reached within what it allows', () => {
    const guide = new Guide();
    const fine = { ...pose([0, 0, 0]), nearM: 0.001, nearRad: 0.1 };
    guide.begin({ exercise: { guide: [fine, pose([0.02, 0, 0])] } } as unknown as Bundle);
    const turned = (rad: number) => new THREE.Quaternion().setFromAxisAngle(axes.z, rad);
    guide.follow(1, at(0.0012), q, none);
    guide.follow(1, at(0), turned(0.12), none);
    expect(guide.target(1)!.at).toBe(0);
    guide.follow(1, at(0.0008), turned(0.08), none);
    expect(guide.target(1)!.at).toBe(1);
  });

  it('is less exact for a button of a hand that stays where it is', () => {
    const guide = new Guide();
    const fine = (x: number, button1: boolean) => ({ ...pose([x, 0, 0], button1), nearM: 0.001 });
    guide.begin({ exercise: { guide: [fine(0, true), fine(0.0003, false), fine(0.02, false)] } } as unknown as Bundle);
    const held = { button1: true, button2: false };
    guide.follow(1, at(0.0015), q, held);
    expect(guide.target(1)!.at).toBe(0);
    guide.follow(1, at(0.0005), q, held);
    expect(guide.target(1)!.at).toBe(1);
    guide.follow(1, at(0.0019), q, none);
    expect(guide.target(1)!.at).toBe(2);
  });

  it('says when the example moves the other hand first', () => {
    const guide = new Guide();
    const when = (hand: 'left' | 'right', x: number, timeS: number): GuidePose => ({ ...pose([x, 0, 0]), hand, timeS });
    const poses = [when('left', 0, 1), when('left', 0.02, 9), when('right', 0, 4), when('right', 0.02, 9.3)];
    guide.begin({ exercise: { guide: poses } } as unknown as Bundle);
    expect([guide.waits(0), guide.waits(1)]).toEqual([false, true]);
    guide.follow(0, at(0), q, none);
    expect([guide.waits(0), guide.waits(1)]).toEqual([true, false]);
    guide.follow(1, at(0), q, none);
    // At nearly the same time both may go on.
    expect([guide.waits(0), guide.waits(1)]).toEqual([false, false]);
  });

  it('knows when a hand has followed it to its end, and then keeps no other hand waiting', () => {
    const guide = new Guide();
    const when = (hand: 'left' | 'right', x: number, timeS: number): GuidePose => ({ ...pose([x, 0, 0]), hand, timeS });
    guide.begin({ exercise: { guide: [when('left', 0, 1), when('right', 0, 4)] } } as unknown as Bundle);
    expect([guide.ended(0), guide.waits(1)]).toEqual([false, true]);
    guide.follow(0, at(0), q, none);
    expect([guide.ended(0), guide.waits(1)]).toEqual([true, false]);
    guide.step(0, -1);
    expect(guide.ended(0)).toBe(false);
  });

  it('goes on when a pose is reached with its buttons, and passes no pose over', () => {
    const guide = new Guide();
    const poses = [pose([0, 0, 0]), pose([0.02, 0, 0]), pose([0.04, 0, 0]), pose([0.04, 0, 0], true)];
    guide.begin({ exercise: { guide: poses } } as unknown as Bundle);
    expect(guide.target(0)).toBeNull();
    guide.follow(1, at(0.01), q, none);
    expect(guide.target(1)!.at).toBe(0);
    guide.follow(1, at(0.021), q, none);
    expect(guide.target(1)!.at).toBe(0);
    for (const x of [0.001, 0.021, 0.04]) guide.follow(1, at(x), q, none);
    expect(guide.target(1)!.at).toBe(3);
    expect(buttonsToDo(guide.target(1)!.target, none)).toBe('At the target: hold button 1 (Space)');
    // A way to and fro is not cut short where it comes back to.
    guide.begin({ exercise: { guide: [0, 0.02, 0, 0.02, 0].map((x) => pose([x, 0, 0])) } } as unknown as Bundle);
    const seen = [0, 0.02, 0, 0.02].map((x) => {
      // It stays there for a while.
      for (let k = 0; k < 3; k++) guide.follow(1, at(x), q, none);
      return guide.target(1)!.at;
    });
    expect(seen).toEqual([1, 2, 3, 4]);
    guide.begin({ exercise: { guide: poses } } as unknown as Bundle);
    const wrong = new THREE.Quaternion().setFromAxisAngle(axes.z, 0.5);
    guide.restart();
    guide.follow(1, at(0), wrong, none);
    expect(guide.target(1)!.at).toBe(0);
    guide.step(1, 1);
    guide.step(1, 1);
    guide.step(1, -1);
    expect(guide.target(1)!.at).toBe(1);
  });
});

describe('words', () => {
  it('stand beside colours', () => {
    expect([1, 0, -1].map((good) => verdict({ good }))).toEqual(['✓ good', '', '✗ not good']);
    expect(timesText({ count: 3, timesS: [1.5, 61] })).toBe('0:01.5, 1:01.0, 1 more');
    expect(timesText({ count: 2, timesS: [] })).toBe('');
  });
  it('name software rendering', () => {
    expect(adviceFor('ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device), SwiftShader driver)')).toContain('SwiftShader');
    expect(adviceFor('NVIDIA GeForce RTX 3060/PCIe/SSE2')).toBe('');
  });
});
