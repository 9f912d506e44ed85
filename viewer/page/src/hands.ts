// SPDX-License-Identifier: GPL-3.0-or-later
// The two hands that a viewer may drive. One is active: mouse, keys and touch move it. A hand is the user's from its
// first movement until it is given back, and only then its pose is sent, 60 times a second. It stays where it is while
// the other one is moved, and a button that is held then stays on, latched.
import * as THREE from 'three';
import type { Microscope } from './camera';
import type { Connection } from './connection';
import { type Button, HandPose } from './hand_pose';

export interface ToolPoses {
  /** Present pose of the tool held by a hand, or null. */
  toolPose(hand: number): { p: THREE.Vector3; q: THREE.Quaternion } | null;
  /** How the hand's tool should be turned for its target; null: there is no target. */
  wanted(hand: number): THREE.Quaternion | null;
}

/** buttons: of the hand, 1 and 2. resting: it is held where it is. */
export interface HandState {
  taken: boolean;
  resting: boolean;
  buttons: { on: boolean; latched: boolean }[];
}

/** A way in the picture, m: to the right, up, to the viewer. */
export interface Way {
  right?: number;
  up?: number;
  out?: number;
}

/** A turn about the tip, rad: about the shaft, about the picture's upright axis, about its level axis. */
export interface Turn {
  roll?: number;
  swing?: number;
  tilt?: number;
}

const sendPeriodMs = 1000 / 60;
/** Of the wrist that is turned to its target, rad/s. */
export const assistRadPerS = 0.6;
const sideOf = (hand: number): string => (hand === 0 ? 'left' : 'right');

export class Hands {
  readonly hands = [new HandPose(), new HandPose()];
  active = 1;
  /** The hand whose wrist is being turned to its target; -1: none. */
  assisted = -1;
  /** What moves hands as long as it is pressed: called before poses go out, with the seconds since the last time. */
  readonly steady: ((dt: number) => void)[] = [];
  /** Called when another hand becomes active, with that hand, and when all are given back. */
  readonly leaving: ((to: number) => void)[] = [];
  private lastSentMs = 0;

  constructor(
    private readonly scope: Pick<Microscope, 'axes' | 'homeTarget'>,
    private readonly link: Pick<Connection, 'sendHand' | 'sendCommand'>,
    private readonly tools: ToolPoses,
    private readonly changed: () => void,
    private readonly mayDrive: boolean,
  ) {}

  setActive(hand: number): void {
    if (hand !== this.active) {
      this.hands[this.active]!.latchHeld();
      this.assisted = -1;
      for (const f of this.leaving) f(hand);
    }
    this.active = hand;
    // It is taken over as it stands.
    this.hands[hand]!.resting = false;
    this.changed();
  }

  /** The hand stays where it is with what its buttons do, and the other one is taken. */
  holdHere(hand = this.active): void {
    if (!this.take(hand)) return;
    this.hands[hand]!.latchHeld();
    this.hands[hand]!.resting = true;
    this.setActive(1 - hand);
    this.take();
    this.changed();
  }

  /** Gives a hand back: its buttons are off, and it glides to where the arm, the motion or its home is. */
  release(hand: number): void {
    const h = this.hands[hand]!;
    if (h.taken) this.link.sendCommand('release', sideOf(hand));
    h.release();
    if (this.assisted === hand) this.assisted = -1;
    this.changed();
  }

  releaseAll(): void {
    this.hands.forEach((_, hand) => this.release(hand));
    for (const f of this.leaving) f(this.active);
  }

  /** A button that is on as long as something is pressed. */
  press(button: Button, on: boolean, hand = this.active): void {
    if (on && !this.take(hand)) return;
    this.hands[hand]!.hold(button, on);
    this.changed();
  }

  /** Latches a hand's button, or lets it go. */
  toggleLatch(hand: number, button: Button): void {
    if (!this.take(hand)) return;
    const h = this.hands[hand]!;
    h.latch(button, !h.on(button));
    this.changed();
  }

  move({ right = 0, up = 0, out = 0 }: Way, hand = this.active): void {
    if (this.hands[hand]!.resting || !this.take(hand)) return;
    const { x, y, z } = this.scope.axes();
    const by = x.multiplyScalar(right).addScaledVector(y, up).addScaledVector(z, out);
    this.hands[hand]!.move(by, this.scope.homeTarget);
  }

  /** What turns the wrist by hand ends the help. */
  turn({ roll = 0, swing = 0, tilt = 0 }: Turn, hand = this.active): void {
    const h = this.hands[hand]!;
    if ((roll === 0 && swing === 0 && tilt === 0) || h.resting || !this.take(hand)) return;
    if (this.assisted === hand) this.assisted = -1;
    const { x, y } = this.scope.axes();
    h.turn(h.shaft(), roll);
    h.turn(y, swing);
    h.turn(x, tilt);
  }

  /** A turn about the tip, in the axes of the picture. */
  rotate(by: THREE.Quaternion, hand: number): void {
    const h = this.hands[hand]!;
    if (h.resting || !this.take(hand)) return;
    const { x, y, z } = this.scope.axes();
    const picture = new THREE.Quaternion().setFromRotationMatrix(new THREE.Matrix4().makeBasis(x, y, z));
    h.q.premultiply(picture.clone().multiply(by).multiply(picture.invert())).normalize();
    if (this.assisted === hand) this.assisted = -1;
  }

  /** A turn as it is seen, rad: clockwise in the picture. */
  rollSeen(clockwise: number, hand = this.active): void {
    const away = this.hands[hand]!.shaft().dot(this.scope.axes().z) < 0;
    this.turn({ roll: away ? clockwise : -clockwise }, hand);
  }

  /** Turns the wrist of the active hand to its target, slowly, or leaves it alone again; its tip stays. */
  toggleAssist(): void {
    const on = this.assisted !== this.active && this.tools.wanted(this.active) !== null && this.take();
    this.assisted = on ? this.active : -1;
    this.changed();
  }

  /** What panels show of each hand. */
  view(): HandState[] {
    return this.hands.map((h) => ({
      taken: h.taken,
      resting: h.resting,
      buttons: ([1, 2] as const).map((b) => ({ on: h.on(b), latched: h.latched(b) })),
    }));
  }

  /** Hands keep their own time: a slow picture must not make them slow. */
  start(): void {
    // Nobody sees the field of a hidden page.
    document.addEventListener('visibilitychange', () => {
      if (document.visibilityState === 'hidden') this.releaseAll();
    });
    let last = performance.now();
    setInterval(() => {
      const now = performance.now();
      this.update(Math.min(0.1, (now - last) / 1000), now);
      last = now;
    }, sendPeriodMs);
  }

  /** What is pressed moves the hands; poses go out at 60 Hz at most. */
  update(dt: number, nowMs: number): void {
    for (const f of this.steady) f(dt);
    this.assist(dt);
    if (nowMs - this.lastSentMs < sendPeriodMs - 2) return;
    this.lastSentMs = nowMs;
    this.hands.forEach((h, hand) => {
      if (!h.taken) return;
      this.link.sendHand({
        hand,
        p_m: Float64Array.from(h.p.toArray()),
        q: Float64Array.from([h.q.w, h.q.x, h.q.y, h.q.z]),
        button1: h.button1,
        button2: h.button2,
      });
    });
  }

  /** The hand becomes the user's where its tool is; false: it cannot. */
  take(hand = this.active): boolean {
    if (!this.mayDrive) return false;
    const h = this.hands[hand]!;
    if (h.taken) return true;
    const pose = this.tools.toolPose(hand);
    if (!pose) return false;
    h.take(pose.p, pose.q);
    this.changed();
    return true;
  }

  /** The window has lost the keys: what they held is let go, what is latched stays. */
  letGoHeld(): void {
    for (const h of this.hands) h.letGoHeld();
    this.changed();
  }

  private assist(dt: number): void {
    const hand = this.assisted;
    if (hand < 0) return;
    const wanted = this.tools.wanted(hand);
    const there = !wanted || this.hands[hand]!.turnTo(wanted, assistRadPerS * dt);
    if (!there) return;
    this.assisted = -1;
    this.changed();
  }
}
