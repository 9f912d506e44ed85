// SPDX-License-Identifier: GPL-3.0-or-later
// The shader of a membrane between two fibres: it sags when slack, clouds when drawn out, and tents over a tool that
// presses on it. It opens from where it tears, bares an arched edge when one of its fibres parts, and shrinks back to
// both attachments when both have parted.
import * as THREE from 'three';
import { type FieldUniforms, injectVeil } from '../materials/field';
import { noiseGlsl, noiseTexture } from '../materials/noise';
import type { MaterialData } from '../step_data/declarations';

const shape = /* glsl */ `
attribute vec3 i_from, i_to, j_from, j_to;
attribute vec4 state; // health of both fibres, seconds since each parted (-1: whole)
attribute vec3 slack; // sag of both fibres in metres, seed
attribute vec3 rise; // of the tent's tip over its foot, metres
attribute vec4 tent; // foot of the tip across and along, seconds since the piece tore (-1: it holds), depth in metres
varying vec4 v_sheet; // across, along, wear, how far it has drawn back
varying vec4 v_tent; // from the foot of the tip across and along (1: an edge), hole, steepness of the tent
varying float v_drawn;
varying vec3 v_at;
float drawn_back(float age) { return age < 0.0 ? 0.0 : 1.0 - exp(-age * 7.0); }
// The mesh's middle lies at the foot of the tip.
float warp(float x, float to) {
  to = clamp(to, 0.08, 0.92);
  return x < 0.5 ? 2.0 * x * to : 1.0 - 2.0 * (1.0 - x) * (1.0 - to);
}
float from_foot(float x, float to) {
  to = clamp(to, 0.08, 0.92);
  return x < to ? (x - to) / to : (x - to) / (1.0 - to);
}
// As a film over a rod: steep at the tip, level where it is attached.
float tent_height(float across, float along) {
  float r = length(vec2(from_foot(across, tent.x), from_foot(along, tent.y)));
  return pow(max(0.0, 1.0 - r), 1.6);
}
vec3 sheet_place(float across, float along, float half_of, vec3 aside) {
  vec3 tented = rise * tent_height(across, along);
  float back_i = drawn_back(state.z), back_j = drawn_back(state.w);
  float free = sin(3.14159 * along);
  // A free edge arches between the attachments towards the fibre that stands.
  float s = across;
  s = mix(s, 1.0, 0.86 * back_i * (1.0 - back_j) * sqrt(free) * (1.0 - s));
  s = mix(s, 0.0, 0.86 * back_j * (1.0 - back_i) * sqrt(free) * s);
  // Nothing stands: a ragged fringe is left at each attachment.
  float both = back_i * back_j;
  float ragged = 0.10 + 0.10 * sin(across * 23.0 + slack.z * 40.0) * sin(across * 9.0 + slack.z * 17.0);
  float keep = mix(1.0, ragged + 0.06, both);
  float t = half_of < 0.5 ? along * keep : 1.0 - (1.0 - along) * keep;
  vec3 from = mix(i_from, j_from, s), to = mix(i_to, j_to, s);
  float length_m = distance(from, to);
  float hang = mix(slack.x, slack.y, s) * 0.8 + 0.03 * length_m;
  vec3 x = mix(from, to, t);
  float taut = 1.0 - smoothstep(0.0, 0.0004, tent.w);
  float wave = hang * sin(slack.z * 61.0) + 0.05 * length_m * sin(s * 6.0 + slack.z * 31.0);
  x += tented + aside * sin(3.14159 * t) * wave * taut;
  // The loose fringe curls out of its plane.
  return x + aside * both * min(t, 1.0 - t) * length_m * 1.2 * sin(across * 7.0 + slack.z * 50.0);
}
`;

const normal = /* glsl */ `
        vec3 span = normalize(mix(j_from, j_to, 0.5) - mix(i_from, i_to, 0.5) + vec3(1e-9));
        vec3 aside = normalize(cross(span, normalize(i_to - i_from + vec3(1e-9))) + vec3(1e-6));
        float across = warp(position.x, tent.x), along = warp(position.y, tent.y), half_of = position.z;
        vec3 here = sheet_place(across, along, half_of, aside);
        float e = 0.04;
        float ea = position.x > 0.5 ? -e : e, et = position.y > 0.5 ? -e : e;
        vec3 du = (sheet_place(across + ea, along, half_of, aside) - here) * sign(ea);
        vec3 dv = (sheet_place(across, along + et, half_of, aside) - here) * sign(et);
        vec3 objectNormal = normalize(cross(du, dv) + aside * 1e-9);`;

const place = /* glsl */ `
        vec3 transformed = here;
        float wear = 1.0 - mix(state.x, state.y, across);
        v_sheet = vec4(across, along, wear, max(drawn_back(state.z), drawn_back(state.w)));
        float length_now = distance(mix(i_from, j_from, across), mix(i_to, j_to, across));
        v_drawn = 1.0 - smoothstep(0.0, 0.25, mix(slack.x, slack.y, across) / (length_now + 1e-6));
        vec2 off = vec2(from_foot(across, tent.x), from_foot(along, tent.y));
        float span_m = 0.5 * min(distance(i_from, i_to), distance(i_from, j_from)) + 1e-6;
        v_tent = vec4(off, drawn_back(tent.z), clamp(tent.w / span_m, 0.0, 1.0));
        v_at = (mix(i_from, j_from, across) * (1.0 - along) + mix(i_to, j_to, across) * along) * 1000.0;`;

const colour = /* glsl */ `#include <color_fragment>
        vec3 film = vec3(v_sheet.x, v_sheet.y, 0.0);
        vec4 cloud = noise(v_at * 0.9);
        vec4 grain = noise(v_at * 2.7 + cloud.yzw * 0.6);
        // Trabeculae: thickened lines that run from lip to lip and branch.
        float line = 1.0 - smoothstep(0.0, 0.11, abs(noise(v_at * 0.75 + grain.yzw * 0.25 + 3.0).x));
        line = max(line, 0.7 * (1.0 - smoothstep(0.0, 0.09, abs(noise(v_at * 1.7 + 9.0).x))));
        float facing = abs(dot(normalize(vViewPosition), normalize(vNormal)));
        float edge_on = pow(1.0 - facing, 2.0);
        float thick = 0.032 + 0.025 * cloud.x + 0.015 * grain.x + 0.06 * line + 0.04 * v_drawn;
        thick += 0.07 * edge_on;
        // What is drawn over a tip is folded towards it, whitens, and thins out there.
        float off = length(v_tent.xy);
        float ray = sin(atan(v_tent.y, v_tent.x + 1e-6) * 9.0 + 5.0 * cloud.x + 9.0 * grain.x);
        float pulled = v_tent.w * smoothstep(1.0, 0.25, off) * smoothstep(0.0, 0.2, off);
        thick += pulled * (0.05 + 0.12 * smoothstep(0.35, 1.0, ray));
        // Windows between the trabeculae.
        float window = smoothstep(0.16, 0.44, noise(v_at * 0.62 + 21.0).x + 0.25 * grain.x);
        thick *= 1.0 - 0.88 * window * (1.0 - line);
        // It is thickest where it is attached, and thins where it is worn.
        thick *= mix(1.0, 1.5, smoothstep(0.30, 0.5, abs(film.y - 0.5)));
        thick *= 1.0 - 0.75 * v_sheet.z;
        thick = mix(thick, 0.30 + 0.2 * cloud.x, v_sheet.w);
        // A torn piece opens from its tip; a thicker rolled rim and a fringe are left.
        float rim = off - v_tent.z * (0.80 + 0.22 * cloud.x + 0.16 * grain.x);
        if (v_tent.z > 0.0) {
          if (rim < 0.0) discard;
          thick = mix(thick, 0.42 + 0.2 * grain.x, 0.8 * exp(-rim * rim / 0.006));
        }
        float attached = smoothstep(0.36, 0.5, abs(film.y - 0.5));
        diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.72, 0.44, 0.40), 0.25 + 0.35 * attached);
        diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.86, 0.83, 0.80), 0.35 * v_drawn * line);
        diffuseColor.a = clamp(diffuseColor.a * thick, 0.0, 0.92);`;

export function sheetMaterial(field: FieldUniforms, material: MaterialData): THREE.MeshPhysicalMaterial {
  const [red, green, blue, alpha] = material.rgba;
  const m = new THREE.MeshPhysicalMaterial({
    // Thinner than a fibre: it takes on more of what lies below.
    color: new THREE.Color().setRGB(0.88 * red, 0.76 * green, 0.71 * blue, THREE.SRGBColorSpace),
    opacity: alpha,
    roughness: Math.max(0.3, material.roughness),
    clearcoat: 1,
    clearcoatRoughness: 0.14,
    envMapIntensity: 0.6,
    transparent: true,
    depthWrite: false,
    side: THREE.DoubleSide,
  });
  m.onBeforeCompile = (shader) => {
    injectVeil(shader, field);
    shader.uniforms.noise_map = { value: noiseTexture() };
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `#include <common>\n${shape}`)
      .replace('#include <beginnormal_vertex>', normal)
      .replace('#include <begin_vertex>', place);
    shader.fragmentShader = shader.fragmentShader
      .replace(
        '#include <common>',
        `#include <common>\n${noiseGlsl}\nvarying vec4 v_sheet, v_tent; varying float v_drawn; varying vec3 v_at;`,
      )
      .replace('#include <color_fragment>', colour)
      .replace(
        '#include <clearcoat_normal_fragment_maps>',
        `#include <clearcoat_normal_fragment_maps>
        clearcoatNormal = normalize(clearcoatNormal + (0.16 + 0.2 * pulled) * (cloud.yzw + 0.6 * grain.yzw));`,
      )
      .replace(
        '#include <lights_fragment_end>',
        `#include <lights_fragment_end>
        // A clear film glistens as a thick one does.
        float gloss = dot(clearcoatSpecularDirect + 0.5 * clearcoatSpecularIndirect, vec3(0.33));
        diffuseColor.a = clamp(diffuseColor.a + 0.5 * smoothstep(0.10, 1.0, gloss), 0.0, 0.9);`,
      );
  };
  m.customProgramCacheKey = () => 'sheets';
  return m;
}
