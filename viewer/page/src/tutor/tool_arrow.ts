// SPDX-License-Identifier: GPL-3.0-or-later
// An arrow over the field that points at the tip of a tool. It is as large as the picture is.
import * as THREE from 'three';
import type { Sight } from '../camera';

/** In hundredths of the picture's height. */
const length = 7;
const away = 1.5;
const beatsPerS = 1.2;

export class ToolArrow {
  readonly root = new THREE.Group();
  private readonly flat = new THREE.MeshBasicMaterial({
    color: 0xffd166,
    transparent: true,
    opacity: 0.95,
    depthTest: false,
    depthWrite: false,
    toneMapped: false,
    side: THREE.DoubleSide,
  });
  private readonly arrow: THREE.Mesh;

  constructor() {
    // It points down the y axis, its point at the origin.
    const shape = new THREE.Shape();
    const outline: [number, number][] = [
      [0.24, 0.42],
      [0.1, 0.42],
      [0.1, 1],
      [-0.1, 1],
      [-0.1, 0.42],
      [-0.24, 0.42],
    ];
    shape.moveTo(0, 0);
    for (const [x, y] of outline) shape.lineTo(x, y);
    this.arrow = new THREE.Mesh(new THREE.ShapeGeometry(shape), this.flat);
    this.arrow.frustumCulled = false;
    this.arrow.renderOrder = 895;
    this.root.add(this.arrow);
    this.root.visible = false;
  }

  /** tip: what it points at; null: it is not shown. */
  update(tip: THREE.Vector3 | null, { axes, percentM }: Sight, seconds: number): void {
    this.root.visible = tip !== null;
    if (!tip) return;
    const basis = new THREE.Matrix4().makeBasis(axes.x, axes.y, axes.z);
    this.root.quaternion.setFromRotationMatrix(basis);
    const lift = away * (1.4 + Math.sin(2 * Math.PI * beatsPerS * seconds));
    this.root.position.copy(tip).addScaledVector(axes.y, lift * percentM);
    this.root.scale.setScalar(length * percentM);
  }

  dispose(): void {
    this.root.removeFromParent();
    this.arrow.geometry.dispose();
    this.flat.dispose();
  }
}
