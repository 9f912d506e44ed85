// SPDX-License-Identifier: GPL-3.0-or-later
// The shader of a fibre: a tube between two moving ends that sags, waves, wears, and recoils to both sides when it
// parts.
import * as THREE from 'three';
import { type FieldUniforms, injectVeil } from '../materials/field';
import type { MaterialData } from '../step_data/declarations';

/** Seconds until a parted fibre has gone. */
export const fadeS = 2.2;

const shape = /* glsl */ `
attribute vec3 end_a, end_b;
attribute vec4 state; // radius, health, tension, seconds since it parted (-1: whole)
attribute vec2 slack; // sag in metres, seed
varying vec4 v_fibre;
vec3 fibre_root(bool second, vec3 n1, vec3 n2) {
  float seed = slack.y * 6.2832;
  vec3 aside = n1 * sin(seed * 7.0) + n2 * cos(seed * 7.0);
  return (second ? end_b : end_a) + aside * min(0.0003, 0.10 * distance(end_a, end_b));
}
vec3 fibre_centre(float t, bool second, vec3 n1, vec3 n2) {
  float length_m = distance(end_a, end_b);
  float seed = slack.y * 6.2832;
  float bow = sin(3.14159 * t);
  vec3 c = mix(end_a, end_b, t);
  vec3 sag = n1 * cos(seed) + n2 * sin(seed);
  float loose = clamp(slack.x / (0.3 * length_m + 1e-6), 0.0, 1.0);
  float wave = length_m * (0.020 + 0.06 * loose) * bow;
  vec3 ripple = n1 * sin(t * (5.0 + 6.0 * fract(seed * 1.7)) + seed * 3.0);
  ripple += n2 * sin(t * (8.0 + 7.0 * fract(seed * 2.9)) + seed * 5.0);
  c += sag * slack.x * bow + wave * ripple;
  // The fibres of a bundle part company towards the attachments.
  float out_there = abs(2.0 * t - 1.0);
  c += (n1 * sin(seed * 7.0) + n2 * cos(seed * 7.0)) * min(0.0003, 0.10 * length_m) * out_there * out_there;
  if (state.w >= 0.0) {
    float keep = mix(0.16, 1.0, exp(-state.w * 8.0));
    float s = second ? (1.0 - t) * 2.0 : t * 2.0;
    vec3 root = fibre_root(second, n1, n2);
    c = root + (c - root) * keep;
    // The loose end whips aside.
    float whip = (1.0 - keep) * s * s * length_m * 0.25 * cos(state.w * 21.0) * exp(-state.w * 3.0);
    c += (n1 * cos(seed * 4.0) + n2 * sin(seed * 4.0)) * whip;
  }
  return c;
}
`;

const fibreNormal = /* glsl */ `
        bool second = position.x > 1.5;
        float t = second ? position.x - 2.0 : position.x;
        vec3 axis = normalize(end_b - end_a + vec3(1e-9));
        vec3 n1 = normalize(cross(axis, abs(axis.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
        vec3 n2 = cross(axis, n1);
        vec3 here = fibre_centre(t, second, n1, n2);
        float e = t > 0.5 ? -0.02 : 0.02;
        vec3 run = normalize((fibre_centre(t + e, second, n1, n2) - here) * sign(e) + axis * 1e-7);
        vec3 m1 = normalize(n1 - dot(n1, run) * run);
        vec3 m2 = cross(run, m1);
        vec3 objectNormal = m1 * position.y + m2 * position.z;`;

const fibrePosition = /* glsl */ `
        float at_end = abs(2.0 * t - 1.0);
        float worn = 1.0 - state.y;
        float radius = state.x * (0.62 + 0.18 * at_end + 0.4 * smoothstep(0.88, 1.0, at_end));
        radius *= (1.0 - 0.45 * worn) * (1.0 - 0.55 * worn * exp(-pow((t - 0.5) / 0.16, 2.0)));
        if (state.w >= 0.0) radius *= 1.0 - 0.9 * (1.0 - at_end);
        vec3 transformed = here + objectNormal * radius;
        v_fibre = vec4(state.yzw, t);`;

const fibreColour = /* glsl */ `#include <color_fragment>
        float pull = v_fibre.y / (v_fibre.y + 0.025);
        float strained = clamp(pull * 0.9 + 0.25 * (1.0 - v_fibre.x), 0.0, 1.0);
        vec3 fibre = mix(0.66 * diffuseColor.rgb * vec3(1.0, 0.92, 0.86), vec3(0.72, 0.20, 0.15), strained);
        // Attachments take the colour of the pia.
        fibre = mix(fibre, vec3(0.66, 0.33, 0.29), smoothstep(0.72, 1.0, abs(2.0 * v_fibre.w - 1.0)));
        diffuseColor.rgb = fibre;
        float edge_on = 1.0 - abs(dot(normalize(vViewPosition), normalize(vNormal)));
        diffuseColor.a *= mix(0.12, 0.55, edge_on * edge_on);
        if (v_fibre.z >= 0.0) diffuseColor.a *= 1.0 - smoothstep(0.8, ${fadeS.toFixed(1)}, v_fibre.z);`;

/** Colour, opacity and roughness are the material's; a fibre is clearest where it is seen face on. */
export function fibreMaterial(field: FieldUniforms, material: MaterialData): THREE.MeshPhysicalMaterial {
  const [red, green, blue, alpha] = material.rgba;
  const m = new THREE.MeshPhysicalMaterial({
    color: new THREE.Color().setRGB(red, green, blue, THREE.SRGBColorSpace),
    opacity: alpha,
    roughness: material.roughness,
    clearcoat: 0.8,
    clearcoatRoughness: 0.2,
    transparent: true,
    depthWrite: false,
    side: THREE.DoubleSide,
  });
  m.onBeforeCompile = (shader) => {
    injectVeil(shader, field);
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `#include <common>\n${shape}`)
      .replace('#include <beginnormal_vertex>', fibreNormal)
      .replace('#include <begin_vertex>', fibrePosition);
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', '#include <common>\nvarying vec4 v_fibre; // health, tension, age, t')
      .replace('#include <color_fragment>', fibreColour);
  };
  m.customProgramCacheKey = () => 'fibres';
  return m;
}
