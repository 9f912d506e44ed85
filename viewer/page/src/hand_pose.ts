// SPDX-License-Identifier: GPL-3.0-or-later
// The pose one hand asks for. It starts at the tool's present pose, so nothing jumps, and stays near the field.
import * as THREE from 'three';

const reachM = 0.12;

export class HandPose {
  taken = false;
  button1 = false;
  button2 = false;
  readonly p = new THREE.Vector3();
  readonly q = new THREE.Quaternion();

  take(p: THREE.Vector3, q: THREE.Quaternion): void {
    if (this.taken) return;
    this.taken = true;
    this.p.copy(p);
    this.q.copy(q).normalize();
  }

  release(): void {
    this.taken = this.button1 = this.button2 = false;
  }

  move(by: THREE.Vector3, centre: THREE.Vector3): void {
    this.p.add(by);
    const away = this.p.clone().sub(centre);
    if (away.length() > reachM) this.p.copy(centre).add(away.setLength(reachM));
  }

  /** Turns about the tip, axis in the scene. */
  turn(axis: THREE.Vector3, angle: number): void {
    this.q.premultiply(new THREE.Quaternion().setFromAxisAngle(axis, angle)).normalize();
  }
}
