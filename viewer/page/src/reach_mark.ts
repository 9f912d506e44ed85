// SPDX-License-Identifier: GPL-3.0-or-later
// Where an instrument would hold what it can take back from the field: a ring and the distance. Within
// reach the ring is green and full.
import * as THREE from 'three';
import type { Sight } from './camera';
import { millimetres } from './depth_ruler';
import { hexOf, palette } from './palette';
import type { Within } from './take_back';
import { TextSprite } from './text_sprite';
import { spoken } from './bundle';

/** Farther things have no mark, m. */
export const markedM = 0.04;
const colours = { away: hexOf(palette.high), near: hexOf(palette.good) };

export class ReachMark {
  readonly root = new THREE.Group();
  private readonly flat: THREE.MeshBasicMaterial;
  private readonly ring: THREE.Mesh;
  private readonly disc: THREE.Mesh;
  private readonly label = new TextSprite(0.001, [1, 0.95, 0.8]);

  constructor() {
    const over = { transparent: true, opacity: 0.85, depthTest: false, depthWrite: false, toneMapped: false };
    this.flat = new THREE.MeshBasicMaterial(over);
    this.ring = new THREE.Mesh(new THREE.RingGeometry(0.8, 1, 36), this.flat);
    this.disc = new THREE.Mesh(new THREE.CircleGeometry(0.6, 24), this.flat);
    for (const o of [this.ring, this.disc]) {
      o.frustumCulled = false;
      o.renderOrder = 892;
      this.root.add(o);
    }
    this.root.add(this.label.sprite);
    this.root.visible = false;
  }

  update(within: Within | null, { axes, percentM }: Sight): void {
    this.root.visible = within !== null && within.distanceM <= markedM;
    if (!within || !this.root.visible) return;
    const near = within.taken === true;
    this.flat.color.setHex(near ? colours.near : colours.away);
    this.disc.visible = near;
    for (const o of [this.ring, this.disc]) {
      o.position.copy(within.place);
      o.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), axes.z);
      o.scale.setScalar(1.6 * percentM);
    }
    this.label.setHeight(2.8 * percentM);
    this.label.sprite.position.copy(within.place).addScaledVector(axes.x, 6 * percentM);
    this.label.write(`${spoken(within.tool.kind)} ${millimetres(within.distanceM)}`);
  }

  dispose(): void {
    this.root.removeFromParent();
    this.ring.geometry.dispose();
    this.disc.geometry.dispose();
    this.flat.dispose();
    this.label.dispose();
  }
}
