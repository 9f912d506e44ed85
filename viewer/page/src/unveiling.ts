// SPDX-License-Identifier: GPL-3.0-or-later
// Lets the meshes of a new scene appear by a few shader programs at a time. A browser takes a tenth of a second or more
// for each, so a first picture of everything would take seconds.
import * as THREE from 'three';

/** More hold up the page for longer; fewer need more pictures, which are slow themselves without a graphics card. */
const programsAPicture = 4;

/** No camera sees this layer. */
const hiddenLayer = 31;

/** Meshes that share it share a program, as far as one can tell before it is made. */
function programKey(mesh: THREE.Mesh): string {
  const m = mesh.material as THREE.Material;
  return `${m.type} ${m.customProgramCacheKey()} ${m.side} ${m.transparent}`;
}

export class Unveiling {
  private groups: THREE.Mesh[][];

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

  /** After a picture: some more programs may draw. False: everything is shown. */
  next(): boolean {
    for (let made = 0; made < programsAPicture && this.groups.length > 0;) {
      const group = this.groups.shift()!;
      for (const mesh of group) mesh.layers.set(0);
      if (group.some((m) => m.visible)) made++;
    }
    return this.groups.length > 0;
  }
}
