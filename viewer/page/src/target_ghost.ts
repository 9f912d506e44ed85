// SPDX-License-Identifier: GPL-3.0-or-later
// The ghost of an instrument, with what it holds, at the pose that its hand is to reach.
import * as THREE from 'three';
import type { Bundle, ToolData } from './bundle_types';
import type { RenderFrame } from './lcm';
import { linkPose } from './link_pose';

type FrameTool = RenderFrame['tool'][number];

/** Meshes of one tool in the ghost's look. */
class GhostTool {
  readonly group = new THREE.Group();
  private readonly links: THREE.Group[];

  constructor(
    readonly data: ToolData,
    material: THREE.Material,
  ) {
    this.links = Array.from({ length: data.hinges.length + 1 }, () => new THREE.Group());
    for (const l of this.links) {
      l.matrixAutoUpdate = false;
      this.group.add(l);
    }
    for (const part of data.parts) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(part.positions, 3));
      geometry.setIndex(new THREE.BufferAttribute(part.indices, 1));
      this.links[part.link]!.add(new THREE.Mesh(geometry, material));
    }
    this.group.visible = false;
  }

  open(rad: number): void {
    this.links.forEach((l, k) => {
      linkPose(this.data.hinges, k, rad, l.matrix);
      l.matrixWorldNeedsUpdate = true;
    });
  }

  dispose(): void {
    this.group.traverse((o) => {
      if (o instanceof THREE.Mesh) (o.geometry as THREE.BufferGeometry).dispose();
    });
  }
}

export class TargetGhost {
  readonly root = new THREE.Group();
  private readonly material = new THREE.MeshBasicMaterial({
    color: 0x63ffd1,
    transparent: true,
    opacity: 0.3,
    depthWrite: false,
  });
  private readonly tools = new Map<number, GhostTool>();
  private bundle: Bundle | null = null;

  begin(bundle: Bundle): void {
    for (const t of this.tools.values()) t.dispose();
    this.tools.clear();
    this.root.clear();
    this.bundle = bundle;
  }

  hide(): void {
    for (const t of this.tools.values()) t.group.visible = false;
  }

  /** Shows the tool that is in the hand now, and what it holds, as they would be at the target. */
  show(frame: RenderFrame, held: FrameTool, p: THREE.Vector3, q: THREE.Quaternion): void {
    this.place(held, p, q);
    const back = rotationOf(held).invert();
    const tip = new THREE.Vector3(...held.p_m);
    for (const t of frame.tool) {
      if (t.hand !== held.hand || t.state !== 1 || t.index === held.index) continue;
      const data = this.bundle?.tools.find((d) => d.index === t.index);
      if (!data || data.hand === 'left' || data.hand === 'right') continue;
      const local = new THREE.Vector3(...t.p_m).sub(tip).applyQuaternion(back);
      this.place(t, local.applyQuaternion(q).add(p), q.clone().multiply(back).multiply(rotationOf(t)));
    }
  }

  private place(t: FrameTool, p: THREE.Vector3, q: THREE.Quaternion): void {
    let ghost = this.tools.get(t.index);
    if (!ghost) {
      const data = this.bundle?.tools.find((d) => d.index === t.index);
      if (!data) return;
      ghost = new GhostTool(data, this.material);
      this.tools.set(t.index, ghost);
      this.root.add(ghost.group);
    }
    ghost.group.visible = true;
    ghost.group.position.copy(p);
    ghost.group.quaternion.copy(q);
    ghost.open(t.opening_rad);
  }
}

const rotationOf = (t: FrameTool): THREE.Quaternion => new THREE.Quaternion(t.q[1], t.q[2], t.q[3], t.q[0]);
