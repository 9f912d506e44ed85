// SPDX-License-Identifier: GPL-3.0-or-later
// Where the tools of the hands press on tissue: a ring on each of the strongest places, seen through everything. It
// is wider the stronger the contact, and has the colour of the hand's force bar.
import * as THREE from 'three';
import { glide } from './glide';
import { forceLevel } from './hud/state';
import type { RenderFrame } from './lcm';
import { hexOf, palette } from './palette';

export const markCount = 6;
/** 1/s. */
const fadeRate = 17;
/** Weaker contacts have no mark, N. */
export const leastN = 0.01;
const colours = { good: hexOf(palette.good), high: hexOf(palette.high), too_much: hexOf(palette.bad) };

export interface Contact {
  place: THREE.Vector3;
  forceN: number;
}

/** The strongest contacts that lie within `reach` of a tool's axis, tip to `length` along its shaft. */
export function contactsOfTools(
  frame: Pick<RenderFrame, 'contact_x_m' | 'contact_N'>,
  axes: readonly { tip: THREE.Vector3; shaft: THREE.Vector3 }[],
  reachM = 0.004,
  lengthM = 0.05,
): Contact[] {
  const ways = axes.map(({ tip, shaft }) => {
    // A clip's blades lie before the tip of the applier that holds it.
    const from = tip.clone().addScaledVector(shaft, -0.012);
    return new THREE.Line3(from, tip.clone().addScaledVector(shaft, lengthM));
  });
  const on = new THREE.Vector3();
  return [...frame.contact_N.keys()]
    .map((i) => ({
      place: new THREE.Vector3().fromArray(frame.contact_x_m, 3 * i),
      forceN: frame.contact_N[i]!,
    }))
    .filter((c) => c.forceN >= leastN)
    .filter((c) => ways.some((w) => w.closestPointToPoint(c.place, true, on).distanceTo(c.place) <= reachM))
    .sort((a, b) => b.forceN - a.forceN)
    .slice(0, markCount);
}

/** Radius of a mark, m: a tenth of a newton is a millimetre wide. */
export const markRadius = (forceN: number): number => 0.0004 + 0.0011 * Math.sqrt(Math.min(1, forceN));

export class ContactMarks {
  readonly root = new THREE.Group();
  private readonly ring = new THREE.RingGeometry(0.66, 1, 28);
  private readonly marks: THREE.Mesh<THREE.RingGeometry, THREE.MeshBasicMaterial>[];

  constructor() {
    this.marks = Array.from({ length: markCount }, () => {
      const material = new THREE.MeshBasicMaterial({
        ...{ transparent: true, opacity: 0, depthTest: false, depthWrite: false, toneMapped: false },
      });
      const mark = new THREE.Mesh(this.ring, material);
      mark.frustumCulled = false;
      mark.renderOrder = 889;
      this.root.add(mark);
      return mark;
    });
  }

  /**
   * towards: to the viewer; marks face it. dt: of the picture before, s. They fade, since contacts flicker from step
   * to step.
   */
  update(contacts: readonly Contact[], towards: THREE.Vector3, dt: number): void {
    this.marks.forEach((mark, k) => {
      const c = contacts[k];
      const wanted = c ? 0.85 : 0;
      mark.material.opacity = glide(mark.material.opacity, wanted, fadeRate * dt);
      mark.visible = mark.material.opacity > 0.02;
      mark.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), towards);
      if (!c) return;
      mark.position.copy(c.place);
      mark.scale.setScalar(markRadius(c.forceN));
      mark.material.color.setHex(colours[forceLevel(c.forceN)]);
    });
  }

  dispose(): void {
    this.root.removeFromParent();
    this.ring.dispose();
    for (const m of this.marks) m.material.dispose();
  }
}
