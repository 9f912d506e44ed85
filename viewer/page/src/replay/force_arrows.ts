// SPDX-License-Identifier: GPL-3.0-or-later
// The force that each hand feels, as an arrow at the tip of its tool.
import * as THREE from 'three';
import type { Bundle } from '../bundle_types';
import { toolInHand } from '../hand_tool';
import { forceLevel } from '../hud/state';
import { vector } from '../world';
import { hexOf, palette } from '../palette';
import type { Moment } from './pictures';

/** Weaker forces have no arrow, N. */
const leastN = 0.01;
/** Length of the arrow for one newton, m. */
const lengthOfNewtonM = 0.012;
const longestM = 0.03;
const colours = { good: hexOf(palette.good), high: hexOf(palette.high), too_much: hexOf(palette.bad) };

export class ForceArrows {
  readonly root = new THREE.Group();
  private readonly arrows = [0, 1].map(() => new THREE.ArrowHelper());

  constructor() {
    for (const arrow of this.arrows) {
      for (const part of [arrow.line, arrow.cone]) {
        part.material = new THREE.MeshBasicMaterial({ depthTest: false, toneMapped: false, transparent: true });
        part.renderOrder = 890;
      }
      this.root.add(arrow);
    }
    this.root.visible = false;
  }

  update({ before, after, share }: Moment, bundle: Bundle): void {
    this.arrows.forEach((arrow, hand) => {
      const a = toolInHand(before.frame, bundle, hand);
      const b = toolInHand(after.frame, bundle, hand);
      arrow.visible = false;
      if (!a || !b || a.index !== b.index) return;
      const force = vector(a.force_N).lerp(vector(b.force_N), share);
      const newtons = force.length();
      if (newtons < leastN) return;
      arrow.visible = true;
      arrow.position.copy(vector(a.p_m).lerp(vector(b.p_m), share));
      arrow.setDirection(force.divideScalar(newtons));
      const length = Math.min(longestM, 0.002 + lengthOfNewtonM * newtons);
      arrow.setLength(length, 0.0022, 0.0014);
      arrow.setColor(colours[forceLevel(newtons)]);
    });
  }
}
