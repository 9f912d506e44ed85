// SPDX-License-Identifier: GPL-3.0-or-later
// Rings, discs and balls that mark places on a surface.
import {
  CircleGeometry,
  DoubleSide,
  Mesh,
  MeshBasicMaterial,
  type Object3D,
  Quaternion,
  SphereGeometry,
  TorusGeometry,
  Vector3,
} from 'three';

function placed(mesh: Mesh, centre: Vector3, normal: Vector3): Mesh {
  mesh.position.copy(centre);
  mesh.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), normal.clone().normalize()));
  return mesh;
}

export const ring = (centre: Vector3, normal: Vector3, radius: number, color: string): Mesh =>
  placed(new Mesh(new TorusGeometry(radius, radius / 12, 8, 48), new MeshBasicMaterial({ color })), centre, normal);

/** With its border, which is seen from the side too. */
export function solidDisc(centre: Vector3, normal: Vector3, radius: number, color: string): Object3D[] {
  const material = new MeshBasicMaterial({
    color,
    transparent: true,
    opacity: 0.4,
    side: DoubleSide,
    depthWrite: false,
  });
  const border = new Mesh(new TorusGeometry(radius, radius / 30, 8, 64), new MeshBasicMaterial({ color }));
  return [placed(new Mesh(new CircleGeometry(radius, 48), material), centre, normal), placed(border, centre, normal)];
}

/** Seen through the surface. */
export function ball(centre: Vector3, radius: number, color: string): Mesh {
  const mesh = new Mesh(new SphereGeometry(radius, 16, 12), new MeshBasicMaterial({ color, depthTest: false }));
  mesh.position.copy(centre);
  mesh.renderOrder = 1;
  return mesh;
}
