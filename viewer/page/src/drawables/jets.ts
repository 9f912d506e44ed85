// SPDX-License-Identifier: GPL-3.0-or-later
// Jets of fluid, one a line: from its first point towards its last, as strong as its value (0..1). Drops on ballistic
// paths: a smooth column at their start, which necks, breaks up into drops of unlike size and scatters, as a free jet
// does (Rayleigh and Plateau). Where a drop is follows from its number and the time alone.
import * as THREE from 'three';
import { type FieldUniforms, injectVeil } from '../materials/field';
import { fluidLook } from '../materials/fluid_look';
import type { DrawableContext, Drawn } from './drawn';

const drops = 190;
const cheapDrops = 60;
const lifeS = 0.16;

/** A drowned jet only makes the surface well up. */
const drownedM = 0.0015;

export class Jets implements Drawn {
  readonly root = new THREE.Group();
  private readonly jets: Jet[] = [];
  private cheap = false;

  constructor(private readonly context: DrawableContext) {}

  update(data: Float32Array): void {
    const { field, declared } = this.context;
    const step = 4 * declared.pointsPerLine;
    const n = data.length / step;
    while (this.jets.length < n) this.add();
    const from = new THREE.Vector3();
    const out = new THREE.Vector3();
    field.spring.value.w = 0;
    this.jets.forEach((jet, k) => {
      const strength = k < n ? Math.max(0, Math.min(1, data[step * k + 3]!)) || 0 : 0;
      if (k < n) from.fromArray(data, step * k);
      if (k < n) out.fromArray(data, step * (k + 1) - 4).sub(from);
      if (out.lengthSq() < 1e-18) out.copy(upOf(field));
      const depth = depthOf(field, from);
      const wells = strength * Math.exp(-Math.max(0, depth) * 120);
      if (wells > field.spring.value.w) field.spring.value.set(from.x, from.y, from.z, wells);
      jet.update(from, out.normalize(), depth > drownedM ? 0 : strength);
    });
  }

  setCheap(cheap: boolean): void {
    this.cheap = cheap;
    for (const j of this.jets) j.setCheap(cheap);
  }

  dispose(): void {
    this.root.removeFromParent();
    for (const j of this.jets) j.dispose();
  }

  private add(): void {
    const look = fluidLook(this.context.declared.material, this.context.material);
    const jet = new Jet(this.context.field, new THREE.Color(...look.drop));
    jet.setCheap(this.cheap);
    this.jets.push(jet);
    this.root.add(jet.mesh);
  }
}

const upOf = (field: FieldUniforms): THREE.Vector3 => {
  const p = field.fluidPlane.value;
  return new THREE.Vector3(p.x, p.y, p.z);
};

/** How deep a point lies below the fluid's surface, m; negative above it. */
function depthOf(field: FieldUniforms, at: THREE.Vector3): number {
  const o = field.fluidOrigin.value;
  return (
    field.fluidPlane.value.w -
    at
      .clone()
      .sub(new THREE.Vector3(o.x, o.y, o.z))
      .dot(upOf(field))
  );
}

class Jet {
  readonly mesh: THREE.Mesh;
  private readonly geometry = new THREE.InstancedBufferGeometry();
  private readonly from = { value: new THREE.Vector3() };
  private readonly velocity = { value: new THREE.Vector3() };
  private readonly gravity = { value: new THREE.Vector3() };
  private readonly drops = { value: drops };

  constructor(
    private readonly field: FieldUniforms,
    colour: THREE.Color,
  ) {
    const ball = new THREE.IcosahedronGeometry(1, 1);
    this.geometry.setAttribute('position', ball.attributes.position!);
    this.geometry.setAttribute('normal', ball.attributes.normal!);
    this.geometry.setAttribute(
      'number',
      new THREE.InstancedBufferAttribute(
        Float32Array.from({ length: drops }, (_, i) => i),
        1,
      ),
    );
    this.geometry.instanceCount = drops;
    this.mesh = new THREE.Mesh(this.geometry, this.makeMaterial(colour));
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  setCheap(cheap: boolean): void {
    this.drops.value = this.geometry.instanceCount = cheap ? cheapDrops : drops;
  }

  /** out: unit direction; strength 0..1. */
  update(from: THREE.Vector3, out: THREE.Vector3, strength: number): void {
    this.mesh.visible = strength > 0.01;
    if (!this.mesh.visible) return;
    const up = upOf(this.field);
    this.from.value.copy(from);
    this.velocity.value
      .copy(out)
      .addScaledVector(up, 0.35)
      .normalize()
      .multiplyScalar(0.04 + 0.36 * Math.sqrt(strength));
    this.gravity.value.copy(up).multiplyScalar(-9.81 * 0.4);
  }

  dispose(): void {
    this.geometry.dispose();
    (this.mesh.material as THREE.Material).dispose();
  }

  private makeMaterial(colour: THREE.Color): THREE.MeshPhysicalMaterial {
    const gloss = { roughness: 0.4, clearcoat: 0.6, clearcoatRoughness: 0.25, envMapIntensity: 0.4 };
    const m = new THREE.MeshPhysicalMaterial({ color: colour, ...gloss });
    m.onBeforeCompile = (shader) => {
      injectVeil(shader, this.field);
      Object.assign(shader.uniforms, {
        seconds: this.field.seconds,
        pulse: this.field.pulse,
        from: this.from,
        velocity: this.velocity,
        gravity: this.gravity,
        drops: this.drops,
      });
      shader.vertexShader = shader.vertexShader
        .replace(
          '#include <common>',
          `#include <common>
          attribute float number;
          uniform float seconds, pulse, drops; uniform vec3 from, velocity, gravity;
          float chance(float n) { return fract(sin(n * 12.9898) * 43758.547); }`,
        )
        .replace(
          '#include <beginnormal_vertex>',
          `
          float turn = seconds / ${lifeS.toFixed(2)} + number / drops;
          float age = fract(turn) * ${lifeS.toFixed(2)};
          float lot = number + 17.0 * mod(floor(turn), 97.0);
          // The pressure when the drop left.
          float push = 0.55 + 0.55 * pulse * exp(-age * 6.0);
          vec3 side = vec3(chance(lot), chance(lot + 3.3), chance(lot + 7.7)) - 0.5;
          float share = age / ${lifeS.toFixed(2)};
          // The column holds together over its first fifth; then every drop goes its own way.
          float broken = smoothstep(0.16, 0.5, share);
          vec3 v = velocity * push * (1.0 + (0.24 * chance(lot + 1.7) - 0.12) * broken);
          v += side * length(velocity) * (0.05 + 0.42 * chance(lot + 5.0) * chance(lot + 2.1)) * broken;
          vec3 now = v + gravity * age;
          vec3 run = normalize(now);
          float strong = clamp((length(velocity) - 0.04) / 0.36, 0.0, 1.0);
          float size = 0.00027 * (0.35 + 0.65 * strong);
          float luck = chance(lot + 9.1);
          // The column pinches before it breaks: then few large drops and many small ones are left.
          float neck = 0.82 + 0.18 * sin(share * 60.0 - seconds * 40.0);
          size *= mix(0.75 * neck, 0.22 + 1.05 * luck * luck * luck, broken) * (1.0 - 0.3 * share);
          float stretch = 1.0 + mix(4.5, 1.2 * (1.0 - luck), broken);
          vec3 objectNormal = normalize(normal - run * dot(normal, run) * (1.0 - 1.0 / stretch));`,
        )
        .replace(
          '#include <begin_vertex>',
          `
          vec3 body = position + run * dot(position, run) * (stretch - 1.0);
          vec3 transformed = from + v * age + 0.5 * gravity * age * age + body * size;`,
        );
    };
    m.customProgramCacheKey = () => 'jet';
    return m;
  }
}
