// SPDX-License-Identifier: GPL-3.0-or-later
// The two eyepieces. Both look along the same axis from places beside each other, with frusta sheared so that they
// meet at the focus: what is in focus has no parallax, as with a microscope's common objective.
import * as THREE from 'three';

/** Distance between the eyes for a convergence angle at the focus. */
export function eyeSeparation(focusM: number, angleRad: number): number {
  return 2 * focusM * Math.tan(angleRad / 2);
}

/** Sets up the camera of one eye (-1 left, +1 right) from the middle one. */
export function placeEye(
  middle: THREE.PerspectiveCamera,
  side: -1 | 1,
  focusM: number,
  angleRad: number,
  aspect: number,
  eye: THREE.PerspectiveCamera,
): void {
  const half = (side * eyeSeparation(focusM, angleRad)) / 2;
  middle.updateMatrixWorld();
  const x = new THREE.Vector3().setFromMatrixColumn(middle.matrixWorld, 0);
  eye.quaternion.copy(middle.quaternion);
  eye.position.copy(middle.position).addScaledVector(x, half);
  eye.fov = middle.fov;
  eye.aspect = aspect;
  eye.near = middle.near;
  eye.far = middle.far;
  const high = middle.near * Math.tan(THREE.MathUtils.degToRad(middle.fov) / 2);
  const wide = high * aspect;
  const shift = (-half * middle.near) / focusM;
  eye.projectionMatrix.makePerspective(
    shift - wide,
    shift + wide,
    high,
    -high,
    middle.near,
    middle.far,
    eye.coordinateSystem,
  );
  eye.projectionMatrixInverse.copy(eye.projectionMatrix).invert();
  eye.updateMatrixWorld();
}

/** Colour matrices of the red-cyan anaglyph that least squares fit to filters and eyes (Dubois 2001), rows r g b. */
export const anaglyphLeft = [0.437, 0.449, 0.164, -0.062, -0.062, -0.024, -0.048, -0.05, -0.017] as const;
export const anaglyphRight = [-0.011, -0.032, -0.007, 0.377, 0.761, 0.009, -0.026, -0.093, 1.234] as const;
