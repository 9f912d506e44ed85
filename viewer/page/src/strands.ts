// SPDX-License-Identifier: GPL-3.0-or-later
// Arachnoid strands between the lobes: each a small bundle of tapered fibres that fans out at its attachments, waves when
// slack, straightens and reddens under tension, thins as it wears, and recoils to both sides when it parts. Fine cross
// filaments tie neighbours into a web.
import * as THREE from 'three';
import { type FieldUniforms, inject_veil } from './materials/field';
import { make_random } from './random';

const fibres_per_strand = 3;
const rings_per_half = 9;
const sides = 5;
/** Seconds until a severed strand has gone. */
const fade_s = 2.2;
const whole_mark = Infinity;

interface Fibre {
  /** Strand at each end and where along it the end sits; a strand's own fibre goes from 0 to 1 of the same strand. */
  a: number;
  b: number;
  ta: number;
  tb: number;
  radius: number;
}

export class Strands {
  readonly mesh: THREE.Mesh;
  private readonly geometry = new THREE.InstancedBufferGeometry();
  private readonly ends_a: THREE.InstancedBufferAttribute;
  private readonly ends_b: THREE.InstancedBufferAttribute;
  private readonly state: THREE.InstancedBufferAttribute;
  private readonly slack: THREE.InstancedBufferAttribute;
  private readonly fibres: Fibre[] = [];
  private readonly ends: Float32Array;
  private readonly integrity: Float32Array;
  private readonly tension: Float32Array;
  private readonly rest_length: Float32Array;
  private readonly severed_at: Float64Array;
  private webbed = false;

  constructor(private readonly count: number, private readonly radius_m: number, field: FieldUniforms) {
    const capacity = count * (fibres_per_strand + 2);
    this.ends = new Float32Array(count * 6);
    this.integrity = new Float32Array(count);
    this.tension = new Float32Array(count);
    this.rest_length = new Float32Array(count);
    this.severed_at = new Float64Array(count).fill(whole_mark);
    const random = make_random(101);
    for (let i = 0; i < count; i++)
      for (let k = 0; k < fibres_per_strand; k++) this.fibres.push({ a: i, b: i, ta: 0, tb: 1, radius: radius_m * (k === 0 ? 0.75 : 0.28 + 0.22 * random()) });
    this.build_tube();
    const dynamic = (size: number) => {
      const a = new THREE.InstancedBufferAttribute(new Float32Array(capacity * size), size);
      a.setUsage(THREE.DynamicDrawUsage);
      return a;
    };
    this.ends_a = dynamic(3);
    this.ends_b = dynamic(3);
    this.state = dynamic(4);
    this.slack = dynamic(2);
    this.geometry.setAttribute('end_a', this.ends_a);
    this.geometry.setAttribute('end_b', this.ends_b);
    this.geometry.setAttribute('state', this.state);
    this.geometry.setAttribute('slack', this.slack);
    this.geometry.instanceCount = 0;
    this.mesh = new THREE.Mesh(this.geometry, strand_material(field));
    this.mesh.frustumCulled = false;
    this.mesh.receiveShadow = true;
    this.mesh.renderOrder = 2;
  }

  /** ends: 6 floats a strand (both end points); time in seconds, any steady clock. */
  update(ends: Float32Array, integrity: Float32Array, tension: Float32Array, time: number): void {
    const n = Math.min(this.count, integrity.length, Math.floor(ends.length / 6));
    for (let i = 0; i < n; i++) {
      const whole = integrity[i]! >= 0;
      const whole_before = this.integrity[i]! >= 0;
      // A severed strand keeps the last ends known when the engine no longer sends any.
      let any = false;
      for (let k = 0; k < 6; k++) any ||= ends[i * 6 + k] !== 0;
      if (any) for (let k = 0; k < 6; k++) this.ends[i * 6 + k] = ends[i * 6 + k]!;
      if (whole) this.severed_at[i] = whole_mark;
      // Already parted when this page came: nothing to animate.
      else if (this.severed_at[i] === whole_mark) this.severed_at[i] = whole_before && this.webbed ? time : time - 1e6;
      this.integrity[i] = integrity[i]!;
      this.tension[i] = tension[i] ?? 0;
      const length = this.length(i);
      if (this.rest_length[i] === 0 && any) this.rest_length[i] = length;
      if (this.tension[i]! > 1e-6 && length > 0) this.rest_length[i] = Math.min(this.rest_length[i]!, length);
    }
    if (!this.webbed && n > 0) { this.webbed = true; this.weave(n); }
    let out = 0;
    this.fibres.forEach((f, index) => {
      if (f.a >= n || f.b >= n) return;
      const severed = Math.max(this.age(f.a, time), this.age(f.b, time));
      if (severed > fade_s) return;
      const own = f.a === f.b;
      for (let k = 0; k < 3; k++) {
        this.ends_a.array[out * 3 + k] = this.along(f.a, f.ta, k);
        this.ends_b.array[out * 3 + k] = this.along(f.b, f.tb, k);
      }
      this.state.array.set([f.radius, Math.max(0, Math.min(this.integrity[f.a]!, this.integrity[f.b]!)), own ? this.tension[f.a]! : 0, severed], out * 4);
      const l0 = this.rest_length[f.a]!;
      const l = this.length(f.a);
      const loose = own ? Math.sqrt(Math.max(0, l0 * l0 - l * l)) * 0.38 : 0.0002;
      this.slack.array.set([loose, (index * 0.6180339887) % 1], out * 2);
      out++;
    });
    this.geometry.instanceCount = out;
    for (const a of [this.ends_a, this.ends_b, this.state, this.slack]) a.needsUpdate = true;
  }

  dispose(): void {
    this.geometry.dispose();
    (this.mesh.material as THREE.Material).dispose();
  }

  private age(i: number, time: number): number { return this.integrity[i]! >= 0 ? -1 : time - this.severed_at[i]!; }

  private along(i: number, t: number, k: number): number { return this.ends[i * 6 + k]! * (1 - t) + this.ends[i * 6 + 3 + k]! * t; }

  private length(i: number): number {
    const e = this.ends;
    return Math.hypot(e[i * 6]! - e[i * 6 + 3]!, e[i * 6 + 1]! - e[i * 6 + 4]!, e[i * 6 + 2]! - e[i * 6 + 5]!);
  }

  /** Cross filaments to the two nearest neighbours. */
  private weave(n: number): void {
    const random = make_random(55);
    for (let i = 0; i < n; i++) {
      if (this.integrity[i]! < 0) continue;
      const near: { j: number; d: number }[] = [];
      for (let j = 0; j < n; j++) {
        if (j === i || this.integrity[j]! < 0) continue;
        const d = Math.hypot(...[0, 1, 2].map((k) => this.along(i, 0.5, k) - this.along(j, 0.5, k)));
        if (d < 0.0045) near.push({ j, d });
      }
      near.sort((a, b) => a.d - b.d);
      for (const { j } of near.slice(0, 2)) {
        if (j < i && random() < 0.5) continue;
        this.fibres.push({ a: i, b: j, ta: 0.15 + 0.7 * random(), tb: 0.15 + 0.7 * random(), radius: this.radius_m * 0.28 });
      }
    }
  }

  /** A unit tube in two halves: position = (along, cos, sin). */
  private build_tube(): void {
    const position: number[] = [];
    const index: number[] = [];
    for (let half = 0; half < 2; half++)
      for (let r = 0; r < rings_per_half; r++) {
        const t = half * 0.5 + (r / (rings_per_half - 1)) * 0.5;
        for (let k = 0; k < sides; k++) {
          const angle = (k / sides) * 2 * Math.PI;
          // t of the second half is stored with 2 added, so that the shader can tell the halves apart in the middle.
          position.push(half ? t + 2 : t, Math.cos(angle), Math.sin(angle));
          if (r + 1 < rings_per_half) {
            const a = (half * rings_per_half + r) * sides + k, b = (half * rings_per_half + r) * sides + ((k + 1) % sides);
            index.push(a, b, a + sides, b, b + sides, a + sides);
          }
        }
      }
    this.geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
    this.geometry.setIndex(index);
  }
}

const shape = /* glsl */ `
attribute vec3 end_a, end_b;
attribute vec4 state; // radius, health, tension, seconds since it parted (-1: whole)
attribute vec2 slack; // sag in metres, seed
varying vec4 v_strand;
vec3 strand_root(bool second, vec3 n1, vec3 n2) {
  float seed = slack.y * 6.2832;
  return (second ? end_b : end_a) + (n1 * sin(seed * 7.0) + n2 * cos(seed * 7.0)) * min(0.0003, 0.10 * distance(end_a, end_b));
}
vec3 strand_centre(float t, bool second, vec3 n1, vec3 n2) {
  float length_m = distance(end_a, end_b);
  float seed = slack.y * 6.2832;
  float bow = sin(3.14159 * t);
  vec3 c = mix(end_a, end_b, t);
  vec3 sag = n1 * cos(seed) + n2 * sin(seed);
  float loose = clamp(slack.x / (0.3 * length_m + 1e-6), 0.0, 1.0);
  float wave = length_m * (0.020 + 0.06 * loose) * bow;
  c += sag * slack.x * bow + wave * (n1 * sin(t * (5.0 + 6.0 * fract(seed * 1.7)) + seed * 3.0) + n2 * sin(t * (8.0 + 7.0 * fract(seed * 2.9)) + seed * 5.0));
  // The fibres of a bundle part company towards the attachments.
  float out_there = abs(2.0 * t - 1.0);
  c += (n1 * sin(seed * 7.0) + n2 * cos(seed * 7.0)) * min(0.0003, 0.10 * length_m) * out_there * out_there;
  if (state.w >= 0.0) {
    float keep = mix(0.16, 1.0, exp(-state.w * 8.0));
    float s = second ? (1.0 - t) * 2.0 : t * 2.0;
    vec3 root = strand_root(second, n1, n2);
    c = root + (c - root) * keep;
    // The loose end whips aside.
    float whip = (1.0 - keep) * s * s * length_m * 0.25 * cos(state.w * 21.0) * exp(-state.w * 3.0);
    c += (n1 * cos(seed * 4.0) + n2 * sin(seed * 4.0)) * whip;
  }
  return c;
}
`;

function strand_material(field: FieldUniforms): THREE.MeshPhysicalMaterial {
  const m = new THREE.MeshPhysicalMaterial({
    color: 0xffffff, roughness: 0.35, clearcoat: 0.8, clearcoatRoughness: 0.2, transparent: true, depthWrite: false, side: THREE.DoubleSide,
  });
  m.onBeforeCompile = (shader) => {
    inject_veil(shader, field);
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `#include <common>\n${shape}`)
      .replace('#include <beginnormal_vertex>', `
        bool second = position.x > 1.5;
        float t = second ? position.x - 2.0 : position.x;
        vec3 axis = normalize(end_b - end_a + vec3(1e-9));
        vec3 n1 = normalize(cross(axis, abs(axis.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
        vec3 n2 = cross(axis, n1);
        vec3 here = strand_centre(t, second, n1, n2);
        float e = t > 0.5 ? -0.02 : 0.02;
        vec3 run = normalize((strand_centre(t + e, second, n1, n2) - here) * sign(e) + axis * 1e-7);
        vec3 m1 = normalize(n1 - dot(n1, run) * run);
        vec3 m2 = cross(run, m1);
        vec3 objectNormal = m1 * position.y + m2 * position.z;`)
      .replace('#include <begin_vertex>', `
        float at_end = abs(2.0 * t - 1.0);
        float worn = 1.0 - state.y;
        float radius = state.x * (0.62 + 0.18 * at_end + 0.4 * smoothstep(0.88, 1.0, at_end));
        radius *= (1.0 - 0.45 * worn) * (1.0 - 0.55 * worn * exp(-pow((t - 0.5) / 0.16, 2.0)));
        if (state.w >= 0.0) radius *= 1.0 - 0.9 * (1.0 - at_end);
        vec3 transformed = here + objectNormal * radius;
        v_strand = vec4(state.yzw, t);`);
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', '#include <common>\nvarying vec4 v_strand; // integrity, tension, age, t')
      .replace('#include <color_fragment>', `#include <color_fragment>
        float pull = v_strand.y / (v_strand.y + 0.025);
        vec3 strand = mix(vec3(0.80, 0.74, 0.69), vec3(0.72, 0.20, 0.15), clamp(pull * 0.9 + 0.25 * (1.0 - v_strand.x), 0.0, 1.0));
        // Attachments take the colour of the pia.
        strand = mix(strand, vec3(0.66, 0.33, 0.29), smoothstep(0.72, 1.0, abs(2.0 * v_strand.w - 1.0)));
        diffuseColor.rgb = strand;
        float edge_on = 1.0 - abs(dot(normalize(vViewPosition), normalize(vNormal)));
        diffuseColor.a = mix(0.36, 0.78, edge_on * edge_on);
        if (v_strand.z >= 0.0) diffuseColor.a *= 1.0 - smoothstep(0.8, ${fade_s.toFixed(1)}, v_strand.z);`);
  };
  m.customProgramCacheKey = () => 'strands';
  return m;
}
