// SPDX-License-Identifier: GPL-3.0-or-later
// Instruments drawn as ghosts: translucent, of one colour, without light.
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

export class GhostTools {
  readonly root = new THREE.Group();
  private readonly material: THREE.MeshBasicMaterial;
  private readonly tools = new Map<number, GhostTool>();
  private bundle: Bundle | null = null;

  constructor(color: THREE.ColorRepresentation) {
    this.material = new THREE.MeshBasicMaterial({ color, transparent: true, opacity: 0.4, depthWrite: false });
  }

  begin(bundle: Bundle): void {
    for (const t of this.tools.values()) t.dispose();
    this.tools.clear();
    this.root.clear();
    this.bundle = bundle;
  }

  hide(): void {
    for (const t of this.tools.values()) t.group.visible = false;
  }

  /** Number of tools that are shown. */
  get shown(): number {
    return [...this.tools.values()].filter((t) => t.group.visible).length;
  }

  data(index: number): ToolData | null {
    return this.bundle?.tools.find((d) => d.index === index) ?? null;
  }

  /** Shows a tool at a pose until the next hide(), opened as the frame says. */
  place(t: Pick<FrameTool, 'index' | 'opening_rad'>, p: THREE.Vector3, q: THREE.Quaternion): void {
    let ghost = this.tools.get(t.index);
    if (!ghost) {
      const data = this.data(t.index);
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
