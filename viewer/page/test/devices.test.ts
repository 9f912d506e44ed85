// SPDX-License-Identifier: GPL-3.0-or-later
// Gamepads and the controllers of a headset as two hands, against a made-up pad and made-up controllers.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { type Controller, ControllerHands, readControllers } from '../src/controller_hands';
import { deflection, GamepadHands, type Pad, readPad } from '../src/gamepad_hands';
import { Hands } from '../src/hands';
import { fakeGamepad } from './fake_gamepad';

function bench(basis = new THREE.Matrix4()) {
  const axes = () => {
    const [x, y, z] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
    basis.extractBasis(x, y, z);
    return { x, y, z };
  };
  return new Hands(
    { axes, homeTarget: new THREE.Vector3() },
    { sendHand: () => undefined, sendCommand: () => undefined },
    { toolPose: () => ({ p: new THREE.Vector3(), q: new THREE.Quaternion() }), wanted: () => null },
    () => undefined,
    true,
  );
}

const places = (hands: Hands) => hands.hands.map((h) => h.p.toArray().map((c) => Number(c.toFixed(6)) + 0));
const buttons = (hands: Hands) => hands.hands.map((h) => [h.button1, h.button2]);

describe('a gamepad', () => {
  const plugged = (...pads: ReturnType<typeof fakeGamepad>[]) => {
    const hands = bench();
    const list: (Pad | null)[] = [null, ...pads];
    let free = true;
    new GamepadHands(
      hands,
      () => list,
      () => free,
    );
    let now = 0;
    const step = (times = 50) => {
      for (let k = 0; k < times; k++) hands.update(0.02, (now += 20));
    };
    return { hands, list, step, setFree: (f: boolean) => (free = f) };
  };

  it('rests in the middle of its sticks, and is fine beside it', () => {
    expect([deflection(0.1), deflection(-0.15), deflection(NaN)]).toEqual([0, 0, 0]);
    expect([deflection(1), deflection(-1), deflection(-2)]).toEqual([1, -1, -1]);
    expect(deflection(0.575)).toBeCloseTo(0.25, 9);
  });

  it('takes no hand while nothing is moved', () => {
    const { hands, step } = plugged(fakeGamepad());
    step();
    expect(hands.view().map((h) => h.taken)).toEqual([false, false]);
  });

  it('moves two hands at once, each by its own stick', () => {
    const pad = fakeGamepad();
    const { hands, step } = plugged(pad);
    pad.axes = [1, 0, 0, -1];
    step();
    expect(places(hands)).toEqual([
      [0.02, 0, 0],
      [0, 0.02, 0],
    ]);
  });

  it('pushes deeper with the shoulder button, away from the user, and rolls', () => {
    const pad = fakeGamepad();
    const { hands, step } = plugged(pad);
    pad.press(5);
    pad.axes = [0, 0, 0, -1];
    step();
    expect(places(hands)[1]).toEqual([0, 0, -0.012]);
    pad.axes = [0, 0, 1, 0];
    step();
    // Clockwise in the picture about a shaft to the viewer.
    const roll = 2 * Math.atan2(hands.hands[1]!.q.z, hands.hands[1]!.q.w);
    expect(roll).toBeCloseTo(-0.9, 6);
    expect(hands.view()[0]!.taken).toBe(false);
  });

  it('swings each tool by its own four buttons', () => {
    const pad = fakeGamepad();
    pad.press(15);
    pad.press(0);
    const [left, right] = readPad(pad);
    expect([left.swing, left.tilt, right.swing, right.tilt]).toEqual([1, 0, 0, 1]);
  });

  it('presses buttons with its triggers, and lets a latched one go', () => {
    const pad = fakeGamepad();
    const { hands, step } = plugged(pad);
    pad.press(6, 0.4);
    pad.buttons[6]!.pressed = false;
    step(1);
    expect(buttons(hands)[0]).toEqual([false, false]);
    pad.press(6, 0.8);
    pad.press(11);
    step(1);
    expect(buttons(hands)).toEqual([
      [true, false],
      [false, true],
    ]);
    pad.press(6, 0);
    step(1);
    expect(buttons(hands)[0]).toEqual([false, false]);
    hands.toggleLatch(0, 1);
    pad.press(6);
    step(1);
    expect(buttons(hands)[0]).toEqual([false, false]);
  });

  it('lets go what it pressed when it is unplugged, and drives nothing while a question is open', () => {
    const pad = fakeGamepad();
    const { hands, list, step, setFree } = plugged(pad);
    pad.press(7);
    step(1);
    expect(buttons(hands)[1]).toEqual([true, false]);
    list.length = 0;
    step(1);
    expect(buttons(hands)[1]).toEqual([false, false]);
    list.push(pad);
    setFree(false);
    pad.axes = [1, 1, 1, 1];
    step(5);
    expect(places(hands)).toEqual([
      [0, 0, 0],
      [0, 0, 0],
    ]);
  });

  it('leaves a hand that is held here alone', () => {
    const pad = fakeGamepad();
    const { hands, step } = plugged(pad);
    hands.holdHere(1);
    pad.axes = [1, 0, 1, 0];
    step();
    expect(places(hands)).toEqual([
      [0.02, 0, 0],
      [0, 0, 0],
    ]);
  });

  it('is left alone when its mapping is not known', () => {
    const pad = { ...fakeGamepad(), mapping: '', axes: [1, 1, 1, 1] };
    const { hands, step } = plugged(pad);
    step();
    expect(hands.view().some((h) => h.taken)).toBe(false);
  });
});

describe('controllers of a headset', () => {
  const at = (hand: number, x: number, more: Partial<Controller> = {}): Controller => ({
    hand,
    p: new THREE.Vector3(x, 0, 0),
    q: new THREE.Quaternion(),
    squeezed: true,
    button1: false,
    button2: false,
    ...more,
  });

  it('draw their tools by a fifth of their way while they are squeezed, and without a jump', () => {
    const hands = bench();
    const two = new ControllerHands(hands);
    two.move([at(0, 0.3), at(1, 0.5)]);
    expect(places(hands)).toEqual([
      [0, 0, 0],
      [0, 0, 0],
    ]);
    two.move([at(0, 0.35), at(1, 0.4)]);
    expect(places(hands)).toEqual([
      [0.01, 0, 0],
      [-0.02, 0, 0],
    ]);
    // The arm goes back, and the tool stays.
    two.move([at(0, 0.1, { squeezed: false })]);
    two.move([at(0, 0.2)]);
    two.move([at(0, 0.25)]);
    expect(places(hands)[0]![0]).toBeCloseTo(0.02, 6);
  });

  it('turn their tools as they are turned, in the axes of the picture', () => {
    // The picture's right is the scene's y, its up the scene's z, and it is seen from the scene's x.
    const basis = new THREE.Matrix4().makeBasis(
      new THREE.Vector3(0, 1, 0),
      new THREE.Vector3(0, 0, 1),
      new THREE.Vector3(1, 0, 0),
    );
    const hands = bench(basis);
    const two = new ControllerHands(hands);
    two.move([at(1, 0)]);
    two.move([at(1, 0, { q: new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(1, 0, 0), 0.4) })]);
    const expected = new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(0, 1, 0), 0.4);
    expect(hands.hands[1]!.q.angleTo(expected)).toBeLessThan(1e-6);
    two.move([at(1, 0.1, { q: new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(1, 0, 0), 0.4) })]);
    expect(places(hands)[1]).toEqual([0, 0.02, 0]);
  });

  it('press buttons, and let them go when they are lost', () => {
    const hands = bench();
    const two = new ControllerHands(hands);
    two.move([at(0, 0, { button1: true, squeezed: false }), at(1, 0, { button2: true, squeezed: false })]);
    expect(buttons(hands)).toEqual([
      [true, false],
      [false, true],
    ]);
    two.move([at(1, 0, { button2: true, squeezed: false })]);
    expect(buttons(hands)[0]).toEqual([false, false]);
    two.move([]);
    expect(buttons(hands)[1]).toEqual([false, false]);
  });

  it('are read from the session: those with a side and a place', () => {
    const source = (handedness: string, grip: object | null, pressed: number[]) => ({
      handedness,
      gripSpace: grip,
      gamepad: { buttons: Array.from({ length: 6 }, (_, b) => ({ pressed: pressed.includes(b) })) },
    });
    const [seen, unseen] = [{ name: 'seen' }, { name: 'unseen' }];
    const transform = { position: { x: 1, y: 2, z: 3 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
    const frame = { getPose: (space: unknown) => (space === seen ? { transform } : null) };
    const found = readControllers(
      [source('left', seen, [0, 1]), source('right', unseen, [4]), source('none', seen, [])] as never,
      frame as never,
      {} as never,
    );
    expect(found).toHaveLength(1);
    expect(found[0]).toMatchObject({ hand: 0, squeezed: true, button1: true, button2: false });
    expect(found[0]!.p.toArray()).toEqual([1, 2, 3]);
  });
});
