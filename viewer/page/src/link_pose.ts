// SPDX-License-Identifier: GPL-3.0-or-later
// Where a link of an articulated tool stands: turned about its hinge by multiplier times the opening angle.
import * as THREE from 'three';
import type { HingeData } from './bundle_types';

/** Pose of the link in the tool's frame: x -> q (x - origin) + origin. Link 0 is the root and stays. */
export function linkPose(
  hinges: readonly HingeData[],
  link: number,
  openingRad: number,
  out = new THREE.Matrix4(),
): THREE.Matrix4 {
  const hinge = hinges[link - 1];
  if (!hinge || !Number.isFinite(openingRad)) return out.identity();
  const origin = new THREE.Vector3(...hinge.origin);
  out.makeRotationAxis(new THREE.Vector3(...hinge.axis).normalize(), hinge.multiplier * openingRad);
  return out.setPosition(origin.clone().sub(origin.clone().applyMatrix4(out)));
}
