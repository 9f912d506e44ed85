// SPDX-License-Identifier: GPL-3.0-or-later
// Places that a hand is led to when it has followed the example to its end: points whose material has the style "aim".
import * as THREE from 'three';
import type { Bundle } from './bundle_types';
import type { RenderFrame } from './lcm';
import { StyledPlaces } from './styled_places';

/** Tissue moves: a place so near to the chosen one in a later frame is still that one, m. */
const sameM = 0.0015;

export class Aims {
  /** A mark at each place. */
  readonly root = new THREE.Group();
  private readonly ball = new THREE.IcosahedronGeometry(1, 2);
  private readonly look = new THREE.MeshBasicMaterial({
    transparent: true,
    // Places in the depth shine through what lies over them.
    depthTest: false,
  });
  private readonly marked = new StyledPlaces('aim');
  /** Of the marks. */
  private radiusM = 0;
  private chosen: THREE.Vector3 | null = null;
  private passed: THREE.Vector3[] = [];

  begin(bundle: Bundle): void {
    this.marked.begin(bundle);
    const first = this.marked.first();
    if (first) {
      const [r, g, b, opacity] = first.material.rgba;
      this.look.color.setRGB(r, g, b, THREE.SRGBColorSpace);
      this.look.opacity = opacity;
      this.radiusM = first.declared.radiusM;
    }
    this.restart();
  }

  restart(): void {
    this.chosen = null;
    this.passed = [];
  }

  /** The places in a frame. */
  places(frame: Pick<RenderFrame, 'drawable'>): THREE.Vector3[] {
    return this.marked.in(frame);
  }

  /** The place to go to: the one chosen before while it is there, otherwise the nearest that was not passed over. */
  choose(places: readonly THREE.Vector3[], tip: THREE.Vector3): THREE.Vector3 | null {
    const nearest = (to: THREE.Vector3, among: readonly THREE.Vector3[]) =>
      among.reduce<THREE.Vector3 | null>((a, b) => (a && a.distanceTo(to) <= b.distanceTo(to) ? a : b), null);
    const same = this.chosen && nearest(this.chosen, places);
    if (same && same.distanceTo(this.chosen!) < sameM) return (this.chosen = same);
    const open = places.filter((p) => !this.passed.some((q) => q.distanceTo(p) < sameM));
    if (open.length === 0) this.passed = [];
    return (this.chosen = nearest(tip, open.length > 0 ? open : places));
  }

  /** Another place, by hand. */
  passOver(): void {
    if (this.chosen) this.passed.push(this.chosen);
    this.chosen = null;
  }

  show(places: readonly THREE.Vector3[]): void {
    while (this.root.children.length < places.length) this.root.add(new THREE.Mesh(this.ball, this.look));
    this.root.children.forEach((mark, k) => {
      mark.visible = k < places.length;
      if (mark.visible) mark.position.copy(places[k]!);
      mark.scale.setScalar(this.radiusM);
    });
  }
}
