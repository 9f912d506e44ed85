// SPDX-License-Identifier: GPL-3.0-or-later
// Instruments and clips at their streamed poses, links at the streamed opening, and a faint ghost where the hand is when the
// tool is held back far from it.
import * as THREE from 'three';
import type { ToolData } from './bundle';
import { creased } from './geometry';
import { link_pose } from './link_pose';
import type { FieldUniforms } from './materials/field';
import { solid_material } from './materials/solid';

const ghost_from_m = 0.004;
/** A retractor's blade presses into tissue between the points where contact is sought: what little pokes through is not shown. */
const blade_forward_m = 0.002;

export class Tool {
  readonly group = new THREE.Group();
  private readonly ghost = new THREE.Group();
  private readonly ghost_material = new THREE.MeshBasicMaterial({ color: 0x8fd8ff, transparent: true, opacity: 0, depthWrite: false });
  private readonly links: THREE.Group[];
  private readonly owned: { dispose(): void }[] = [];

  constructor(readonly data: ToolData, environment: THREE.Texture | null, field: FieldUniforms) {
    this.links = Array.from({ length: data.hinges.length + 1 }, () => new THREE.Group());
    for (const l of this.links) { l.matrixAutoUpdate = false; this.group.add(l); }
    for (const part of data.parts) {
      const shape = creased(part.positions, part.indices, 0.6);
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(shape.positions, 3));
      geometry.setAttribute('normal', new THREE.BufferAttribute(shape.normals, 3));
      const material = solid_material(part.material, field, undefined, part.rgba, data.hand === 'none' && data.clip === null ? blade_forward_m : 0);
      // Metal lives from its reflections: it gets the room brighter than tissue does.
      material.envMap = environment;
      const mesh = new THREE.Mesh(geometry, material);
      mesh.castShadow = true;
      mesh.receiveShadow = true;
      this.links[part.link]!.add(mesh);
      // A clip lies in the field by itself: no hand, no ghost.
      if (data.clip === null && part.link === 0) this.ghost.add(new THREE.Mesh(geometry, this.ghost_material));
      this.owned.push(geometry, material);
    }
    this.owned.push(this.ghost_material);
    this.hide();
  }

  add_to(scene: THREE.Object3D): void { scene.add(this.group, this.ghost); }

  set_pose(p: THREE.Vector3, q: THREE.Quaternion, opening_rad: number, device: THREE.Vector3 | null): void {
    this.group.visible = true;
    this.group.position.copy(p);
    this.group.quaternion.copy(q);
    this.links.forEach((l, k) => { link_pose(this.data.hinges, k, opening_rad, l.matrix); l.matrixWorldNeedsUpdate = true; });
    const gap = device ? device.distanceTo(p) : 0;
    this.ghost.visible = gap > ghost_from_m;
    if (!device) return;
    this.ghost.position.copy(device);
    this.ghost.quaternion.copy(q);
    this.ghost_material.opacity = Math.min(0.16, (gap - ghost_from_m) * 12);
  }

  hide(): void {
    this.group.visible = false;
    this.ghost.visible = false;
  }

  dispose(): void {
    this.group.removeFromParent();
    this.ghost.removeFromParent();
    for (const o of this.owned) o.dispose();
  }
}
