// SPDX-License-Identifier: GPL-3.0-or-later
// The pose one hand asks for, and its two buttons. The pose starts at the tool's present pose, so nothing jumps, and
// stays near the field. A button is on while its key is held, or latched until it is let go on purpose.
import * as THREE from 'three';

const reachM = 0.12;

export type Button = 1 | 2;

export class HandPose {
  taken = false;
  /** It is held where it is; nothing moves it until it is active again. */
  resting = false;
  readonly p = new THREE.Vector3();
  readonly q = new THREE.Quaternion();
  private readonly held = { 1: false, 2: false };
  private readonly kept = { 1: false, 2: false };

  get button1(): boolean {
    return this.on(1);
  }
  get button2(): boolean {
    return this.on(2);
  }

  on(button: Button): boolean {
    return this.held[button] || this.kept[button];
  }

  latched(button: Button): boolean {
    return this.kept[button];
  }

  hold(button: Button, on: boolean): void {
    this.held[button] = on;
  }

  latch(button: Button, on: boolean): void {
    this.kept[button] = on;
    if (!on) this.held[button] = false;
  }

  /** What is held stays on, latched, when its keys go to the other hand. */
  latchHeld(): void {
    for (const b of [1, 2] as const) {
      if (this.held[b]) this.kept[b] = true;
      this.held[b] = false;
    }
  }

  letGoHeld(): void {
    this.held[1] = this.held[2] = false;
  }

  take(p: THREE.Vector3, q: THREE.Quaternion): void {
    if (this.taken) return;
    this.taken = true;
    this.p.copy(p);
    this.q.copy(q).normalize();
  }

  release(): void {
    this.taken = this.resting = false;
    for (const b of [1, 2] as const) this.held[b] = this.kept[b] = false;
  }

  move(by: THREE.Vector3, centre: THREE.Vector3): void {
    this.p.add(by);
    const away = this.p.clone().sub(centre);
    if (away.length() > reachM) this.p.copy(centre).add(away.setLength(reachM));
  }

  /** Direction of the tool's shaft, from the tip. */
  shaft(): THREE.Vector3 {
    return new THREE.Vector3(0, 0, 1).applyQuaternion(this.q);
  }

  /** Turns about the tip towards an orientation by no more than an angle; true: it is there. */
  turnTo(wanted: THREE.Quaternion, atMost: number): boolean {
    this.q.rotateTowards(wanted, atMost).normalize();
    return this.q.angleTo(wanted) < 1e-6;
  }

  /** Turns about the tip, axis in the scene. */
  turn(axis: THREE.Vector3, angle: number): void {
    this.q.premultiply(new THREE.Quaternion().setFromAxisAngle(axis, angle)).normalize();
  }
}
