// SPDX-License-Identifier: GPL-3.0-or-later
// The two eyepieces. Both look along the same axis from places beside each other, with frusta sheared so that they meet at the
// focus: what is in focus has no parallax, as with a microscope's common objective.
import * as THREE from 'three';

export type StereoMode = 'off' | 'sbs' | 'anaglyph' | 'xr';
export const stereo_modes: readonly StereoMode[] = ['off', 'sbs', 'anaglyph', 'xr'];

/** Operating microscopes: 22-25 mm between the beams at a working distance of 250-300 mm. */
export const usual_angle_deg = 5;
export const angle_range_deg = [1, 9] as const;

export const clamp_angle = (deg: number): number => Math.max(angle_range_deg[0], Math.min(angle_range_deg[1], Number.isFinite(deg) ? deg : usual_angle_deg));

/** Distance between the eyes for a convergence angle at the focus. */
export function eye_separation(focus_m: number, angle_rad: number): number {
  return 2 * focus_m * Math.tan(angle_rad / 2);
}

/** Sets up the camera of one eye (-1 left, +1 right) from the middle one. */
export function place_eye(middle: THREE.PerspectiveCamera, side: -1 | 1, focus_m: number, angle_rad: number, aspect: number, eye: THREE.PerspectiveCamera): void {
  const half = (side * eye_separation(focus_m, angle_rad)) / 2;
  middle.updateMatrixWorld();
  const x = new THREE.Vector3().setFromMatrixColumn(middle.matrixWorld, 0);
  eye.quaternion.copy(middle.quaternion);
  eye.position.copy(middle.position).addScaledVector(x, half);
  eye.fov = middle.fov;
  eye.aspect = aspect;
  eye.near = middle.near;
  eye.far = middle.far;
  const high = middle.near * Math.tan(THREE.MathUtils.degToRad(middle.fov) / 2), wide = high * aspect;
  const shift = (-half * middle.near) / focus_m;
  eye.projectionMatrix.makePerspective(shift - wide, shift + wide, high, -high, middle.near, middle.far, eye.coordinateSystem);
  eye.projectionMatrixInverse.copy(eye.projectionMatrix).invert();
  eye.updateMatrixWorld();
}

/** Colour matrices of the red-cyan anaglyph that least squares fit to filters and eyes (Dubois 2001), rows r g b. */
export const anaglyph_left = [0.437, 0.449, 0.164, -0.062, -0.062, -0.024, -0.048, -0.050, -0.017] as const;
export const anaglyph_right = [-0.011, -0.032, -0.007, 0.377, 0.761, 0.009, -0.026, -0.093, 1.234] as const;
