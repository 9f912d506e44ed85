// SPDX-License-Identifier: GPL-3.0-or-later
// Mouse, fingers and pen at a field without a page: which hand they move, and how.
import * as THREE from 'three';
import { beforeAll, describe, expect, it } from 'vitest';
import { HandPointers } from '../src/hand_pointers';
import { Hands } from '../src/hands';
import { FingerBesidePen, PenWrist } from '../src/pen';

beforeAll(() => {
  Object.assign(globalThis, { window: { addEventListener: () => undefined } });
});

const degree = Math.PI / 180;

/** A field of a thousand pixels a metre. */
function field() {
  const turned: string[] = [];
  const scope = {
    axes: () => ({ x: new THREE.Vector3(1, 0, 0), y: new THREE.Vector3(0, 1, 0), z: new THREE.Vector3(0, 0, 1) }),
    homeTarget: new THREE.Vector3(),
    camera: { position: new THREE.Vector3(0, 0, 0.3) },
    metresPerPixel: () => 0.001,
    orbit: () => turned.push('orbit'),
    pan: () => turned.push('pan'),
    zoom: () => turned.push('zoom'),
  };
  const heard = new Map<string, (e: unknown) => void>();
  const canvas = {
    clientHeight: 400,
    addEventListener: (name: string, f: (e: unknown) => void) => heard.set(name, f),
    focus: () => undefined,
    setPointerCapture: () => undefined,
  };
  const hands = new Hands(
    scope,
    { sendHand: () => undefined, sendCommand: () => undefined },
    { toolPose: () => ({ p: new THREE.Vector3(), q: new THREE.Quaternion() }), wanted: () => null },
    () => undefined,
    true,
  );
  new HandPointers(canvas as never, scope as never, hands, () => undefined);
  const tell = (name: string, pointerId: number, pointerType: string, x: number, y: number, more = {}) =>
    heard.get(name)!({
      ...{ pointerId, pointerType, clientX: x, clientY: y, button: 0, shiftKey: false, tiltX: 0, tiltY: 0, twist: 0 },
      ...{ preventDefault: () => undefined },
      ...more,
    });
  const at = (hand: number) => hands.hands[hand]!.p.toArray().map((c) => Number(c.toFixed(9)) + 0);
  return { hands, tell, at, turned };
}

describe('two devices', () => {
  it('drive two hands: the mouse the active one, a finger the other one', () => {
    const { hands, tell, at } = field();
    tell('pointerdown', 1, 'mouse', 0, 0);
    tell('pointermove', 1, 'mouse', 10, 0);
    tell('pointerdown', 2, 'touch', 100, 100);
    tell('pointermove', 2, 'touch', 100, 80);
    expect([at(1), at(0)]).toEqual([
      [0.01, 0, 0],
      [0, 0.02, 0],
    ]);
    // Both keep their hands when the other hand becomes active.
    hands.setActive(0);
    tell('pointermove', 1, 'mouse', 20, 0);
    tell('pointermove', 2, 'touch', 110, 80);
    expect([at(1), at(0)]).toEqual([
      [0.02, 0, 0],
      [0.01, 0.02, 0],
    ]);
  });

  it('are one hand when only one is down: it goes over to the hand that becomes active', () => {
    const { hands, tell, at } = field();
    tell('pointerdown', 1, 'mouse', 0, 0);
    tell('pointermove', 1, 'mouse', 10, 0);
    hands.setActive(0);
    tell('pointermove', 1, 'mouse', 10, 10);
    expect([at(1), at(0)]).toEqual([
      [0.01, 0, 0],
      [0, -0.01, 0],
    ]);
  });

  it('leave two fingers together', () => {
    const { hands, tell, at } = field();
    tell('pointerdown', 1, 'touch', 0, 0);
    tell('pointerdown', 2, 'touch', 100, 0);
    for (const y of [10, 20, 30, 40]) {
      tell('pointermove', 1, 'touch', 0, y);
      tell('pointermove', 2, 'touch', 100, y);
    }
    expect(at(1)[2]).toBeGreaterThan(0);
    expect(hands.view()[0]!.taken).toBe(false);
  });
});

describe('a pen', () => {
  it('leans and twists the tool, with some slack', () => {
    const wrist = new PenWrist();
    const none = wrist.move({ tiltX: 20, tiltY: -10, twist: 350 });
    expect([none.swing, none.tilt, none.clockwise]).toEqual([0, 0, 0]);
    const little = wrist.move({ tiltX: 22, tiltY: -12, twist: 352 });
    for (const turn of [little.swing, little.tilt, little.clockwise]) expect(turn).toBeCloseTo(0, 12);
    const lean = wrist.move({ tiltX: 33, tiltY: -10, twist: 10 });
    expect(lean.swing).toBeCloseTo(10 * degree, 9);
    expect(lean.tilt).toBeCloseTo(0, 9);
    expect(lean.clockwise).toBeCloseTo(17 * degree, 9); // over the full circle
  });

  it('draws the tool and leans it to the side to which it leans', () => {
    const { hands, tell, at } = field();
    tell('pointerdown', 1, 'pen', 0, 0);
    tell('pointermove', 1, 'pen', 5, 0, { tiltX: 0 });
    tell('pointermove', 1, 'pen', 10, 0, { tiltX: 33 });
    expect(at(1)).toEqual([0.01, 0, 0]);
    const shaft = hands.hands[1]!.shaft();
    expect(shaft.x).toBeCloseTo(Math.sin(30 * degree), 6);
    tell('pointermove', 1, 'pen', 10, 0, { tiltX: 33, tiltY: 23 });
    // Towards the user: down in the picture.
    expect(hands.hands[1]!.shaft().y).toBeCloseTo(-Math.sin(20 * degree) * Math.cos(30 * degree), 6);
  });

  it('has a finger beside it for depth, or for roll', () => {
    const { hands, tell, at } = field();
    tell('pointerdown', 1, 'pen', 0, 0);
    tell('pointerdown', 2, 'touch', 200, 0);
    tell('pointermove', 2, 'touch', 200, -12);
    tell('pointermove', 2, 'touch', 200, -112);
    expect(at(1)[2]).toBeLessThan(-0.005);
    expect(at(1).slice(0, 2)).toEqual([0, 0]);
    tell('pointerup', 2, 'touch', 200, -112);
    tell('pointerdown', 3, 'touch', 200, 0);
    tell('pointermove', 3, 'touch', 220, 0);
    tell('pointermove', 3, 'touch', 240, 5);
    // Clockwise in the picture, shaft to the viewer: a negative turn about it.
    expect(hands.hands[1]!.q.z).toBeLessThan(-0.1);
    expect(hands.view()[0]!.taken).toBe(false);
  });

  it('lets the finger keep to what it began', () => {
    const finger = new FingerBesidePen();
    expect(finger.move(4, 2)).toBeNull();
    expect(finger.move(8, 0)).toEqual({ kind: 'roll', by: 8 });
    expect(finger.move(1, 30)).toEqual({ kind: 'roll', by: 1 });
  });
});
