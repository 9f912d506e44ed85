// SPDX-License-Identifier: GPL-3.0-or-later
// Depth on a flat screen: a plumb line from a tool's tip to the tissue below it, with a tick each millimetre and a long
// one at five, a ring where it lands that shrinks as the tip comes near, and the distance in figures. On contact the
// ring closes to a disc.
import * as THREE from 'three';
import { TextSprite } from './text_sprite';
import type { Foot, TissueProbe } from './tissue_probe';
import { fixed } from './languages/numbers';
import { text } from './languages/text';

/** Farther tips have no cue, m. */
export const cueReachM = 0.015;
/** Nearer ones touch: half of the mesh's own roughness, m. */
const touchM = 0.0003;
const everyS = 1 / 20;
const ticks = 15;
const colours = { away: 0x9fe8ff, touching: 0xffc14d };

/** "4.5 mm": by half millimetres; "contact" at the tissue. */
export function distanceText(distanceM: number): string {
  if (distanceM < touchM) return text('contact');
  return `${fixed(Math.round(distanceM * 2000) / 2, 1)} mm`;
}

export class DepthCue {
  readonly root = new THREE.Group();
  private readonly ring: THREE.Mesh;
  private readonly disc: THREE.Mesh;
  private readonly lines: THREE.LineSegments;
  private readonly label = new TextSprite(0.001, [0.85, 0.96, 1]);
  private readonly flat: THREE.MeshBasicMaterial;
  private readonly thin: THREE.LineBasicMaterial;
  private foot: Foot | null = null;
  /** Which of the tips is nearest. */
  private leading = 0;
  private askedAt = -1;

  constructor() {
    const over = { transparent: true, opacity: 0.8, depthTest: false, depthWrite: false };
    this.flat = new THREE.MeshBasicMaterial({ ...over, color: colours.away, side: THREE.DoubleSide });
    this.thin = new THREE.LineBasicMaterial({ ...over, color: colours.away });
    this.ring = new THREE.Mesh(new THREE.RingGeometry(0.82, 1, 40), this.flat);
    this.disc = new THREE.Mesh(new THREE.CircleGeometry(0.7, 24), this.flat);
    const points = new THREE.BufferAttribute(new Float32Array(3 * 2 * (ticks + 1)), 3);
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(), this.thin);
    this.lines.geometry.setAttribute('position', points.setUsage(THREE.DynamicDrawUsage));
    for (const o of [this.ring, this.disc, this.lines]) {
      o.frustumCulled = false;
      o.renderOrder = 890;
      this.root.add(o);
    }
    this.root.add(this.label.sprite);
    this.root.visible = false;
  }

  /** Distance that the cue shows now, m; null: no cue. */
  get distanceM(): number | null {
    return this.root.visible && this.foot ? this.foot.distanceM : null;
  }

  /**
   * `tips`: the points that may touch first, scene frame; none: the hand holds nothing. `side`: to the right in the
   * picture, as long as a hundredth of the picture is high.
   */
  update(tips: readonly THREE.Vector3[], probes: readonly TissueProbe[], seconds: number, side: THREE.Vector3): void {
    // The tissue moves slowly; its search is dearer than the picture of it.
    if (tips.length > 0 && (seconds - this.askedAt >= everyS || seconds < this.askedAt)) {
      this.askedAt = seconds;
      const feet = tips.map((tip) => nearestOf(tip, probes));
      this.foot = feet.reduce((a, b) => (b && (!a || b.distanceM < a.distanceM) ? b : a), null);
      this.leading = Math.max(0, feet.indexOf(this.foot));
    }
    const tip = tips[this.leading];
    this.root.visible = tip !== undefined && this.foot !== null;
    if (tip && this.foot) this.place(tip, this.foot, side);
  }

  dispose(): void {
    this.root.removeFromParent();
    for (const o of [this.ring, this.disc, this.lines]) o.geometry.dispose();
    this.flat.dispose();
    this.thin.dispose();
    this.label.dispose();
  }

  private place(tip: THREE.Vector3, foot: Foot, side: THREE.Vector3): void {
    const touching = foot.distanceM < touchM;
    const colour = touching ? colours.touching : colours.away;
    this.flat.color.setHex(colour);
    this.thin.color.setHex(colour);
    const radius = 0.0006 + 0.16 * Math.max(0, foot.distanceM);
    for (const o of [this.ring, this.disc]) {
      o.position.copy(foot.place).addScaledVector(foot.normal, 0.0001);
      o.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), foot.normal);
      o.scale.setScalar(radius);
    }
    this.disc.visible = touching;
    this.lines.visible = !touching;
    const unit = side.clone().normalize();
    if (!touching) this.rule(tip, foot.place, unit);
    const percent = side.length();
    this.label.setHeight(3.2 * percent);
    this.label.sprite.position.copy(foot.place).addScaledVector(unit, radius + 5 * percent);
    this.label.write(distanceText(foot.distanceM));
  }

  /** The plumb line and its ticks, counted from the tissue. */
  private rule(tip: THREE.Vector3, from: THREE.Vector3, side: THREE.Vector3): void {
    const p = this.lines.geometry.attributes.position as THREE.BufferAttribute;
    const up = tip.clone().sub(from);
    const length = up.length();
    up.normalize();
    p.setXYZ(0, from.x, from.y, from.z);
    p.setXYZ(1, tip.x, tip.y, tip.z);
    let n = 2;
    for (let k = 1; k <= ticks && 0.001 * k < length; k++) {
      const wide = k % 5 === 0 ? 0.0007 : 0.0003;
      for (const s of [-wide, wide]) {
        const q = from
          .clone()
          .addScaledVector(up, 0.001 * k)
          .addScaledVector(side, s);
        p.setXYZ(n++, q.x, q.y, q.z);
      }
    }
    this.lines.geometry.setDrawRange(0, n);
    p.needsUpdate = true;
  }
}

function nearestOf(tip: THREE.Vector3, probes: readonly TissueProbe[]): Foot | null {
  let best: Foot | null = null;
  for (const probe of probes) {
    const foot = probe.nearest(tip, best ? Math.abs(best.distanceM) : cueReachM);
    if (foot && (!best || Math.abs(foot.distanceM) < Math.abs(best.distanceM))) best = foot;
  }
  return best;
}
