// SPDX-License-Identifier: GPL-3.0-or-later
// A pool of fluid in the field: its surface, and the veil over what lies below it. A radius of 0 means a dry field.
import * as THREE from 'three';
import { glide } from '../glide';
import { dryLevel, type FieldUniforms } from '../materials/field';
import { fluidMaterial } from '../materials/fluid';
import { type FluidLook, fluidLook } from '../materials/fluid_look';
import type { DrawableContext, Drawn, Moment } from './drawn';
import { placeDisc } from './shapes';

const stainFadeS = 40;
/** A pool that nothing stirs sets in this time, s. */
const setS = 45;
/** Shallower pools are a film that nobody sees. */
const leastM = 2e-5;

export class FluidPlane implements Drawn {
  readonly root: THREE.Mesh;
  private readonly field: FieldUniforms;
  /** Where the pool was first seen: levels are counted from there. */
  private bottom: THREE.Vector3 | null = null;
  private level: number | null = null;
  private readonly look: FluidLook;
  private readonly clotted = { value: 0 };

  constructor(private readonly context: DrawableContext) {
    this.field = context.field;
    this.look = fluidLook(context.declared.material, context.material);
    const murk = 1 - context.material.translucency;
    const surface = { body: this.look.scatter, murk, clotted: this.clotted };
    const material = fluidMaterial(context.field, context.environment, surface);
    this.root = new THREE.Mesh(new THREE.CircleGeometry(1, 64), material);
    this.root.renderOrder = 3;
    this.root.visible = false;
    this.root.frustumCulled = false;
    if (context.veils) this.field.setFluid(this.look);
  }

  update(data: Float32Array, { dt }: Moment): void {
    const wet = data.length > 0 && data[6]! > 0;
    const up = wet ? placeDisc(this.root, data) : null;
    if (up) this.bottom ??= this.root.position.clone();
    // Frames come at 60 Hz at most; the level glides between them.
    const wanted = up ? this.root.position.clone().sub(this.bottom!).dot(up) : null;
    this.level = wanted === null || this.level === null ? wanted : glide(this.level, wanted, 12 * dt);
    this.root.visible = wet;
    this.set(wet, dt);
    if (up) this.root.position.addScaledVector(up, this.level! - wanted!);
    if (this.context.veils) this.veil(up, wet ? data[6]! : 0, dt);
  }

  dispose(): void {
    this.root.removeFromParent();
    this.root.geometry.dispose();
    (this.root.material as THREE.Material).dispose();
    if (this.context.veils) this.field.fluidPlane.value.w = this.field.stainLevel.value = dryLevel;
  }

  /** What flows stays liquid; what stands sets; a dry field begins anew. */
  private set(wet: boolean, dt: number): void {
    const stirred = this.field.spring.value.w > 0.02;
    const rate = stirred ? 0.25 / setS : 1 / setS;
    this.clotted.value = wet ? Math.min(1, this.clotted.value + rate * this.look.clots * dt) : 0;
  }

  private veil(up: THREE.Vector3 | null, radius: number, dt: number): void {
    const f = this.field;
    const level = this.level ?? dryLevel;
    f.stainLevel.value = Math.max(level, f.stainLevel.value - (dt / stainFadeS) * 0.01);
    f.fluidPlane.value.w = level;
    if (!up || !this.bottom) return;
    f.fluidPlane.value.set(up.x, up.y, up.z, level + leastM);
    f.fluidOrigin.value.set(this.bottom.x, this.bottom.y, this.bottom.z, radius);
  }
}
