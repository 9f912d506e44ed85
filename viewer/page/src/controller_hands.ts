// SPDX-License-Identifier: GPL-3.0-or-later
// The two controllers of a headset as two hands. While its side button is squeezed, a controller draws its tool along:
// a fifth of its way, and all of its turn. Let go, the tool stays and the arm may go back. The trigger is the first
// button, the lower thumb button the second one.
import * as THREE from 'three';
import type { Hands } from './hands';

const share = 0.2;

export interface Controller {
  /** 0 left, 1 right. */
  hand: number;
  /** In the room: x right, y up, z to the user's back. */
  p: THREE.Vector3;
  q: THREE.Quaternion;
  squeezed: boolean;
  button1: boolean;
  button2: boolean;
}

export class ControllerHands {
  private readonly before = new Map<number, Controller>();

  constructor(private readonly hands: Hands) {}

  /** All controllers that are seen now; one that is lost lets its buttons go. */
  move(now: readonly Controller[]): void {
    for (const [hand, was] of this.before)
      if (!now.some((c) => c.hand === hand)) {
        this.press(was, { ...was, button1: false, button2: false });
        this.before.delete(hand);
      }
    for (const c of now) {
      const was = this.before.get(c.hand);
      if (c.squeezed && was?.squeezed) this.draw(was, c);
      else if (c.squeezed) this.hands.take(c.hand);
      this.press(was ?? { ...c, button1: false, button2: false }, c);
      this.before.set(c.hand, { ...c, p: c.p.clone(), q: c.q.clone() });
    }
  }

  private draw(was: Controller, c: Controller): void {
    const way = c.p.clone().sub(was.p).multiplyScalar(share);
    this.hands.move({ right: way.x, up: way.y, out: way.z }, c.hand);
    this.hands.rotate(c.q.clone().multiply(was.q.clone().invert()), c.hand);
  }

  private press(was: Controller, c: Controller): void {
    if (c.button1 !== was.button1) this.hands.press(1, c.button1, c.hand);
    if (c.button2 !== was.button2) this.hands.press(2, c.button2, c.hand);
  }
}

type Frame = Pick<XRFrame, 'getPose'>;

/** Controllers of a session that have a place in the room in this picture. */
export function readControllers(sources: Iterable<XRInputSource>, frame: Frame, room: XRReferenceSpace): Controller[] {
  const found: Controller[] = [];
  for (const s of sources) {
    const pose = s.gripSpace && s.handedness !== 'none' ? frame.getPose(s.gripSpace, room) : null;
    if (!pose) continue;
    const { position: p, orientation: q } = pose.transform;
    const on = (b: number) => s.gamepad?.buttons[b]?.pressed ?? false;
    found.push({
      hand: s.handedness === 'left' ? 0 : 1,
      p: new THREE.Vector3(p.x, p.y, p.z),
      q: new THREE.Quaternion(q.x, q.y, q.z, q.w),
      squeezed: on(1),
      button1: on(0),
      button2: on(4),
    });
  }
  return found;
}
