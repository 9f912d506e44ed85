// SPDX-License-Identifier: GPL-3.0-or-later
// Lets the meshes of a new scene appear by a few shader programs at a time. A browser takes a tenth of a second or more
// for each, so a first picture of everything would take seconds. What is not in the picture yet, such as a clip on the
// tray, is drawn once without size. Its program is ready when it appears.
import * as THREE from 'three';

/** More hold up the page for longer; fewer need more pictures, which are slow themselves without a graphics card. */
const programsAPicture = 4;

/** No camera sees this layer. */
const hiddenLayer = 31;

/** Meshes that share it share a program, as far as one can tell before it is made. */
function programKey(mesh: THREE.Mesh): string {
  const m = mesh.material as THREE.Material;
  return `${mesh.type} ${m.type} ${m.customProgramCacheKey()} ${m.side} ${m.transparent}`;
}

const shown = (o: THREE.Object3D | null): boolean => o === null || (o.visible && shown(o.parent));

export class Unveiling {
  private readonly groups: THREE.Mesh[][];
  /** Undo what one picture needed. */
  private undo: (() => void)[] = [];

  /** later: what the first picture leaves out. */
  constructor(later: readonly THREE.Mesh[]) {
    const groups = new Map<string, THREE.Mesh[]>();
    for (const mesh of later) {
      const key = programKey(mesh);
      groups.set(key, [...(groups.get(key) ?? []), mesh]);
      mesh.layers.set(hiddenLayer);
    }
    this.groups = [...groups.values()];
  }

  /** Before a picture is drawn, when its objects are in place: some more programs may draw. */
  begin(): void {
    for (const group of this.groups.splice(0, programsAPicture)) {
      for (const mesh of group) mesh.layers.set(0);
      const mesh = group.find(shown) ?? group[0]!;
      this.drawAnywhere(mesh);
      if (!shown(mesh)) this.drawWithoutSize(mesh);
    }
  }

  /** After the picture. False: everything was drawn. */
  end(): boolean {
    for (const undo of this.undo.splice(0)) undo();
    return this.groups.length > 0;
  }

  /** Outside the picture, too. */
  private drawAnywhere(mesh: THREE.Mesh): void {
    const { frustumCulled } = mesh;
    mesh.frustumCulled = false;
    this.undo.push(() => (mesh.frustumCulled = frustumCulled));
  }

  /** Shows it and what it belongs to; the outermost of these, which is not in the picture, has no size meanwhile. */
  private drawWithoutSize(mesh: THREE.Mesh): void {
    let outermost: THREE.Object3D = mesh;
    for (let o: THREE.Object3D | null = mesh; o; o = o.parent) {
      if (o.visible) continue;
      const hidden = o;
      outermost = hidden;
      hidden.visible = true;
      this.undo.push(() => (hidden.visible = false));
    }
    const size = outermost.scale.clone();
    outermost.scale.setScalar(0);
    this.undo.push(() => outermost.scale.copy(size));
  }
}
