// SPDX-License-Identifier: GPL-3.0-or-later
// Blood in the field: its level, surface, and the jet out of the tear, from what the engine says of the bleeding.
import * as THREE from 'three';
import type { BloodState } from './hud/state';
import { Jet } from './jet';
import type { FieldUniforms } from './materials/field';
import { fluid_material } from './materials/fluid';

/** A full tear of the wall bleeds about this much. */
const full_rate_mL_min = 60;
const stain_fade_s = 40;

export class Blood {
  readonly surface: THREE.Mesh;
  readonly jet: Jet;
  private readonly spring = { value: new THREE.Vector4() };
  private level = -1;

  constructor(private readonly field: FieldUniforms, environment: THREE.Texture | null) {
    this.surface = new THREE.Mesh(new THREE.CircleGeometry(1, 64), fluid_material(field, this.spring, environment));
    this.surface.renderOrder = 3;
    this.surface.visible = false;
    this.surface.frustumCulled = false;
    this.jet = new Jet(field);
  }

  /** tear: where the wall is open and its normal, when the scene shows a vessel. */
  update(state: BloodState | null, tear: { at: THREE.Vector3; out: THREE.Vector3 } | null, dt: number): void {
    const f = this.field;
    if (!state) { this.level = f.blood_plane.value.w = f.stain_level.value = -1; this.surface.visible = false; this.jet.mesh.visible = false; return; }
    const up = new THREE.Vector3(...state.up).normalize();
    const origin = new THREE.Vector3(...state.origin);
    // Frames come at 60 Hz at most; the level glides between them.
    const wanted = state.height_m > 1e-5 ? state.height_m : -1e-4;
    this.level = this.level < -0.5 ? wanted : this.level + (wanted - this.level) * (1 - Math.exp(-dt * 12));
    f.blood_plane.value.set(up.x, up.y, up.z, this.level > 2e-5 ? this.level : -1);
    f.blood_field.value.set(origin.x, origin.y, origin.z, Math.max(1e-3, state.radius_m));
    f.stain_level.value = Math.max(this.level > 0 ? this.level : -1, f.stain_level.value - (dt / stain_fade_s) * 0.01);
    this.surface.visible = this.level > 2e-5;
    this.surface.position.copy(origin).addScaledVector(up, this.level);
    this.surface.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), up);
    this.surface.scale.set(state.radius_m, state.radius_m, 1);
    const strength = state.open ? Math.min(1, Math.max(0, state.rate_mL_min) / full_rate_mL_min) : 0;
    const at = tear?.at ?? origin;
    const depth = this.level - at.clone().sub(origin).dot(up);
    this.spring.value.set(at.x, at.y, at.z, strength * Math.exp(-Math.max(0, depth) * 120));
    // A drowned jet only makes the surface well up.
    this.jet.update(at, tear?.out ?? up, depth > 0.0015 ? 0 : strength);
  }

  dispose(): void {
    this.surface.geometry.dispose();
    (this.surface.material as THREE.Material).dispose();
    this.jet.dispose();
  }
}
