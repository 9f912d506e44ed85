// SPDX-License-Identifier: GPL-3.0-or-later
// The ghost of an instrument, with what it holds, at the pose that its hand is to reach.
import * as THREE from 'three';
import type { Bundle } from './bundle_types';
import { GhostTools } from './ghost_tools';
import type { RenderFrame } from './lcm';

type FrameTool = RenderFrame['tool'][number];

export class TargetGhost {
  private readonly ghosts = new GhostTools(0x63ffd1);
  readonly root = this.ghosts.root;

  begin(bundle: Bundle): void {
    this.ghosts.begin(bundle);
  }

  hide(): void {
    this.ghosts.hide();
  }

  /** Shows the tool that is in the hand now, and what it holds, as they would be at the target. */
  show(frame: RenderFrame, held: FrameTool, p: THREE.Vector3, q: THREE.Quaternion): void {
    this.ghosts.place(held, p, q);
    const back = rotationOf(held).invert();
    const tip = new THREE.Vector3(...held.p_m);
    for (const t of frame.tool) {
      if (t.hand !== held.hand || t.state !== 1 || t.index === held.index) continue;
      const data = this.ghosts.data(t.index);
      if (!data || data.hand === 'left' || data.hand === 'right') continue;
      const local = new THREE.Vector3(...t.p_m).sub(tip).applyQuaternion(back);
      this.ghosts.place(t, local.applyQuaternion(q).add(p), q.clone().multiply(back).multiply(rotationOf(t)));
    }
  }
}

const rotationOf = (t: FrameTool): THREE.Quaternion => new THREE.Quaternion(t.q[1], t.q[2], t.q[3], t.q[0]);
