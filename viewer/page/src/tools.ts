// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid tools at their streamed poses, links at the streamed opening, and a faint ghost where the hand is when a tool
// is held back far from it.
import * as THREE from 'three';
import type { ToolData } from './bundle_types';
import { creased } from './geometry';
import { indexedGeometry } from './indexed_geometry';
import { linkPose } from './link_pose';
import type { FieldUniforms } from './materials/field';
import { solidMaterial } from './materials/solid';
import type { MaterialData } from './step_data/declarations';

const ghostFromM = 0.004;
/**
 * A blade on an arm presses into tissue between the points where contact is sought: what little pokes through is not
 * shown.
 */
const armForwardM = 0.002;

export interface ToolPose {
  p: THREE.Vector3;
  q: THREE.Quaternion;
  openingRad: number;
  /** Where the hand is; null: no hand holds it. */
  device: THREE.Vector3 | null;
  /** No hand holds it, and it is not free in the field. */
  onArm: boolean;
}

export class Tool {
  readonly group = new THREE.Group();
  private readonly ghost = new THREE.Group();
  private readonly ghostMaterial = new THREE.MeshBasicMaterial({
    color: 0x8fd8ff,
    transparent: true,
    opacity: 0,
    depthWrite: false,
  });
  /** What no hand ever holds has no ghost. */
  private readonly inHand: boolean;
  private readonly forward = { value: 0 };
  private readonly links: THREE.Group[];
  private readonly owned: { dispose(): void }[] = [];

  constructor(
    readonly data: ToolData,
    environment: THREE.Texture | null,
    field: FieldUniforms,
    materials: ReadonlyMap<string, MaterialData>,
  ) {
    this.inHand = data.hand === 'left' || data.hand === 'right';
    this.links = Array.from({ length: data.hinges.length + 1 }, () => new THREE.Group());
    for (const l of this.links) {
      l.matrixAutoUpdate = false;
      this.group.add(l);
    }
    for (const part of data.parts) {
      const geometry = indexedGeometry(creased(part.positions, part.indices, 0.6));
      const declared = materials.get(part.material);
      const material = solidMaterial(part.material, {
        field,
        rgba: part.rgba,
        ...(declared ? { roughness: declared.roughness, metalness: declared.metalness } : {}),
        forward: this.forward,
        engraving: this.inHand ? (part.link === 0 ? 'graduated' : 'none') : part.link > 0 ? 'serrated' : 'none',
      });
      // Metal lives from its reflections: it gets the room brighter than tissue does.
      material.envMap = environment;
      const mesh = new THREE.Mesh(geometry, material);
      mesh.castShadow = true;
      mesh.receiveShadow = true;
      this.links[part.link]!.add(mesh);
      if (this.inHand && part.link === 0) this.ghost.add(new THREE.Mesh(geometry, this.ghostMaterial));
      this.owned.push(geometry, material);
    }
    this.owned.push(this.ghostMaterial);
    this.hide();
  }

  addTo(scene: THREE.Object3D): void {
    scene.add(this.group, this.ghost);
  }

  setPose(pose: ToolPose): void {
    const { p, q, openingRad } = pose;
    const device = this.inHand ? pose.device : null;
    this.forward.value = pose.onArm ? armForwardM : 0;
    this.group.visible = true;
    this.group.position.copy(p);
    this.group.quaternion.copy(q);
    this.links.forEach((l, k) => {
      linkPose(this.data.hinges, k, openingRad, l.matrix);
      l.matrixWorldNeedsUpdate = true;
    });
    const gap = device ? device.distanceTo(p) : 0;
    this.ghost.visible = gap > ghostFromM;
    if (!device) return;
    this.ghost.position.copy(device);
    this.ghost.quaternion.copy(q);
    this.ghostMaterial.opacity = Math.min(0.16, (gap - ghostFromM) * 12);
  }

  /** What of it may touch first, scene frame: its tip, or the tips of its jaws. */
  tips(): THREE.Vector3[] {
    // Closed jaws meet at the tool's origin.
    const jaws = this.links.length > 1 ? this.links.slice(1) : this.links;
    return jaws.map((l) =>
      new THREE.Vector3().applyMatrix4(l.matrix).applyQuaternion(this.group.quaternion).add(this.group.position),
    );
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
