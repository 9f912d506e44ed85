// SPDX-License-Identifier: GPL-3.0-or-later
// Blood spurting from a tear: drops on ballistic paths, so close at their start that they are a jet. Where a drop is follows
// from its number and the time alone.
import * as THREE from 'three';
import { type FieldUniforms, inject_veil } from './materials/field';

const drops = 150;
const cheap_drops = 60;
const life_s = 0.16;

export class Jet {
  readonly mesh: THREE.Mesh;
  private readonly geometry = new THREE.InstancedBufferGeometry();
  private readonly from = { value: new THREE.Vector3() };
  private readonly velocity = { value: new THREE.Vector3() };
  private readonly gravity = { value: new THREE.Vector3() };
  private readonly drops = { value: drops };

  constructor(private readonly field: FieldUniforms) {
    const ball = new THREE.IcosahedronGeometry(1, 1);
    this.geometry.setAttribute('position', ball.attributes.position!);
    this.geometry.setAttribute('normal', ball.attributes.normal!);
    this.geometry.setAttribute('number', new THREE.InstancedBufferAttribute(Float32Array.from({ length: drops }, (_, i) => i), 1));
    this.geometry.instanceCount = drops;
    this.mesh = new THREE.Mesh(this.geometry, this.make_material());
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  set_cheap(cheap: boolean): void {
    this.drops.value = this.geometry.instanceCount = cheap ? cheap_drops : drops;
  }

  /** from: the tear; out: unit normal of the wall there; strength 0..1 of a full tear at systolic pressure. */
  update(from: THREE.Vector3, out: THREE.Vector3, strength: number): void {
    this.mesh.visible = strength > 0.01;
    if (!this.mesh.visible) return;
    const up = this.field.blood_plane.value;
    this.from.value.copy(from);
    this.velocity.value.copy(out).addScaledVector(new THREE.Vector3(up.x, up.y, up.z), 0.35).normalize().multiplyScalar(0.04 + 0.36 * Math.sqrt(strength));
    this.gravity.value.set(up.x, up.y, up.z).multiplyScalar(-9.81 * 0.4);
  }

  dispose(): void {
    this.geometry.dispose();
    (this.mesh.material as THREE.Material).dispose();
  }

  private make_material(): THREE.MeshPhysicalMaterial {
    const m = new THREE.MeshPhysicalMaterial({ color: 0x6a0505, roughness: 0.4, clearcoat: 0.6, clearcoatRoughness: 0.25, envMapIntensity: 0.4 });
    m.onBeforeCompile = (shader) => {
      inject_veil(shader, this.field);
      Object.assign(shader.uniforms, { seconds: this.field.seconds, pulse: this.field.pulse, from: this.from, velocity: this.velocity, gravity: this.gravity, drops: this.drops });
      shader.vertexShader = shader.vertexShader
        .replace('#include <common>', `#include <common>
          attribute float number;
          uniform float seconds, pulse, drops; uniform vec3 from, velocity, gravity;
          float chance(float n) { return fract(sin(n * 12.9898) * 43758.547); }`)
        .replace('#include <beginnormal_vertex>', `
          float turn = seconds / ${life_s.toFixed(2)} + number / drops;
          float age = fract(turn) * ${life_s.toFixed(2)};
          float lot = number + 17.0 * mod(floor(turn), 97.0);
          // The pressure when the drop left.
          float push = 0.55 + 0.55 * pulse * exp(-age * 6.0);
          vec3 side = vec3(chance(lot), chance(lot + 3.3), chance(lot + 7.7)) - 0.5;
          vec3 v = velocity * push * (0.9 + 0.2 * chance(lot + 1.7)) + side * length(velocity) * 0.14 * chance(lot + 5.0);
          vec3 now = v + gravity * age;
          vec3 run = normalize(now);
          float size = 0.00026 * (0.35 + 0.65 * clamp((length(velocity) - 0.04) / 0.36, 0.0, 1.0)) * (1.0 - 0.45 * age / ${life_s.toFixed(2)}) * (0.65 + 0.7 * chance(lot + 9.1));
          float stretch = 1.0 + 7.0 * exp(-age * 18.0);
          vec3 objectNormal = normalize(normal - run * dot(normal, run) * (1.0 - 1.0 / stretch));`)
        .replace('#include <begin_vertex>', `
          vec3 body = position + run * dot(position, run) * (stretch - 1.0);
          vec3 transformed = from + v * age + 0.5 * gravity * age * age + body * size;`);
    };
    m.customProgramCacheKey = () => 'jet';
    return m;
  }
}
