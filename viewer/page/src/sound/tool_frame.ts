// SPDX-License-Identifier: GPL-3.0-or-later
// Points of the scene in the frame of a tool, and back.
import * as THREE from 'three';
import type { RenderFrame } from '../lcm';

export type ToolFrame = Pick<RenderFrame['tool'][number], 'index' | 'hand' | 'state' | 'p_m' | 'q'>;

type PoseFrame = Pick<ToolFrame, 'p_m' | 'q'>;
const position = ({ p_m: p }: PoseFrame) => new THREE.Vector3(p[0], p[1], p[2]);
/** w x y z, as in the messages. */
const rotation = ({ q }: PoseFrame) => new THREE.Quaternion(q[1], q[2], q[3], q[0]).normalize();

/** A point of the scene in the frame of a tool. */
export const inToolFrame = (point: THREE.Vector3, at: PoseFrame): THREE.Vector3 =>
  point.clone().sub(position(at)).applyQuaternion(rotation(at).invert());

/** And back. */
export const inScene = (local: THREE.Vector3, at: PoseFrame): THREE.Vector3 =>
  local.clone().applyQuaternion(rotation(at)).add(position(at));
