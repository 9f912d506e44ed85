// SPDX-License-Identifier: GPL-3.0-or-later
// Wet brain surface: colour from baked convexity and openness, fine capillaries and mottling from noise, a glistening
// film (clearcoat) broken up by small bumps, red light bleeding at grazing angles, fissure and sulci dark.
import * as THREE from 'three';
import { injectSkinning, type SkinTexture } from '../skin_shader';
import { fluorescenceGlsl, type FieldUniforms, injectVeil } from './field';
import type { MaterialData } from '../step_data/declarations';
import { noiseGlsl, noiseTexture } from './noise';

export interface TissueLook {
  crown: string;
  sulcus: string;
  deep: string;
  capillary: string;
  /** 0..1: how many capillaries show. */
  capillaries: number;
  /** 0..1: whitish arachnoid haze over the sulci. */
  haze: number;
}

const looks: Record<string, TissueLook> = {
  cortex: { crown: '#bf7e6e', sulcus: '#963c34', deep: '#4a1210', capillary: '#8a1f1a', capillaries: 1.0, haze: 0.4 },
  pia: { crown: '#c48a79', sulcus: '#9a4c42', deep: '#4a1210', capillary: '#861e19', capillaries: 1.0, haze: 0.6 },
  insula: { crown: '#b67462', sulcus: '#8c3d33', deep: '#46110f', capillary: '#841c17', capillaries: 0.9, haze: 0.3 },
};

/** Of a material that is not among these the colours follow from its own: darker and redder in the folds. */
export function tissueLook(name: string, m: MaterialData): TissueLook {
  const known = looks[name];
  if (known) return known;
  const crown = new THREE.Color().setRGB(m.rgba[0], m.rgba[1], m.rgba[2], THREE.SRGBColorSpace);
  const darker = (r: number, g: number, b: number): string =>
    `#${new THREE.Color(crown.r * r, crown.g * g, crown.b * b).getHexString()}`;
  return {
    crown: darker(1, 1, 1),
    sulcus: darker(0.6, 0.25, 0.25),
    deep: darker(0.13, 0.03, 0.03),
    capillary: '#86201b',
    capillaries: 1 - m.translucency,
    haze: 0.4,
  };
}

/** Where tissue is pressed: place in the scene and force in newtons, strongest first; w = 0 is none. */
export type Pressed = THREE.Vector4[];
export const pressedCount = 8;

const tissueDeclarations = /* glsl */ `#include <common>
        ${noiseGlsl}
        uniform vec3 crown, sulcus, deep, capillary;
        uniform vec2 amounts;
        uniform mat3 normalMatrix;
        varying vec2 v_shading;
        varying vec3 v_rest, v_place;
        uniform vec4 pressed[${pressedCount}];
        // Network of thin lines where warped noise crosses zero; width in noise units. Slope of its ridges in yzw.
        vec4 network(vec3 p, vec3 warp, float width) {
          vec4 n = noise(p + warp);
          float h = 1.0 - smoothstep(0.0, width, abs(n.x));
          return vec4(h, -sign(n.x) * n.yzw * 4.0 * h * (1.0 - h));
        }`;

const tissueColour = /* glsl */ `#include <color_fragment>
        float openness = v_shading.x;
        vec4 coarse = noise(v_rest * 0.16);
        vec4 middle = noise(v_rest * 0.55);
        vec4 fine = noise(v_rest * 2.1);
        vec3 warp = middle.yzw * 0.9;
        float convexity = v_shading.y + 0.18 * coarse.x + 0.08 * middle.x;
        float fold = smoothstep(0.22, -0.42, convexity);
        vec3 tint = mix(crown, sulcus, fold);
        // Patches: perfusion differs a little from gyrus to gyrus.
        tint *= 1.0 + 0.07 * coarse.x + 0.05 * middle.x + 0.05 * fine.x;
        tint = mix(tint, tint * vec3(1.08, 0.86, 0.80), smoothstep(0.0, 0.7, noise(v_rest * 0.3 + 7.3).x));
        // Capillaries: a coarse and a fine net, patchy.
        float patches = smoothstep(-0.1, 0.5, noise(v_rest * 0.33 + 5.7).x);
        vec4 net = 0.45 * network(v_rest * 0.34, warp, 0.055) * smoothstep(-0.25, 0.35, noise(v_rest * 0.21 + 3.1).x)
          + 0.55 * network(v_rest * 0.95 + 11.0, warp * 0.7, 0.11) * patches;
        #ifndef CHEAP
        // The finest net that a microscope resolves: the pia looks velvety, not painted.
        net += 0.30 * network(v_rest * 2.3 + 5.0, middle.yzw * 0.6, 0.16) * smoothstep(-0.35, 0.3, coarse.x);
        vec4 grain = noise(v_rest * 7.3);
        tint *= 1.0 + 0.045 * grain.x;
        #else
        vec4 grain = vec4(0.0);
        #endif
        tint = mix(tint, capillary, clamp(net.x, 0.0, 1.0) * 0.62 * amounts.x);
        // Vessels stand out of the pia, gyri undulate between the sulci.
        vec3 ridges = net.yzw * amounts.x;
        float haze = amounts.y * 0.30 * smoothstep(0.1, 0.9, fold) * smoothstep(-0.3, 0.6, middle.x) * openness;
        tint = mix(tint, vec3(0.86, 0.78, 0.74), haze);
        // Pressed tissue blanches, with a flushed ring around.
        float pale = 0.0, flush = 0.0;
        for (int i = 0; i < ${pressedCount}; i++) {
          float d = distance(v_place, pressed[i].xyz) * 1000.0;
          float f = clamp(pressed[i].w * 5.0, 0.0, 1.0);
          pale += f * exp(-d * d / 2.2);
          flush += f * exp(-(d - 2.6) * (d - 2.6) / 1.2);
        }
        tint = mix(tint, vec3(0.74, 0.60, 0.52), 0.55 * min(1.0, pale));
        tint *= mix(vec3(1.0), vec3(0.95, 0.80, 0.78), min(1.0, flush) * (1.0 - min(1.0, pale)));
        tint = mix(deep, tint, smoothstep(0.06, 0.62, openness));
        diffuseColor.rgb *= tint;`;

const tissueFilm = /* glsl */ `#include <clearcoat_normal_fragment_maps>
        #ifdef USE_CLEARCOAT
        // The fluid film evens out the finest relief.
        vec3 film = 0.10 * coarse.yzw + 0.15 * middle.yzw + 0.11 * fine.yzw + 0.07 * grain.yzw + 0.16 * ridges;
        clearcoatNormal = bump(clearcoatNormal, normalMatrix * film);
        #endif`;

const tissueGloss = /* glsl */ `#include <lights_physical_fragment>
        #ifdef USE_CLEARCOAT
        material.clearcoatRoughness = clamp(0.21 + 0.10 * coarse.x + 0.04 * fine.x, 0.08, 1.0);
        // The film is thick in the folds and thin on the crowns.
        material.clearcoat *= mix(0.62, 1.0, fold);
        #endif`;

const tissueLight = /* glsl */ `#include <lights_fragment_end>
        // Light scattered below the surface comes out redder where the surface turns away.
        float facing = saturate(dot(normalize(vViewPosition), nonPerturbedNormal));
        float rim = (1.0 - facing) * (1.0 - facing);
        reflectedLight.directDiffuse *= mix(vec3(1.0), vec3(1.06, 0.74, 0.68), rim);
        reflectedLight.indirectDiffuse += diffuseColor.rgb * vec3(0.20, 0.045, 0.03) * openness;
        float shut = openness * openness;
        reflectedLight.indirectDiffuse *= openness;
        reflectedLight.indirectSpecular *= shut;
        reflectedLight.directDiffuse *= mix(0.25, 1.0, openness);
        reflectedLight.directSpecular *= mix(0.15, 1.0, openness);
        #ifdef USE_CLEARCOAT
        clearcoatSpecularIndirect *= shut;
        clearcoatSpecularDirect *= mix(0.1, 1.0, shut);
        #endif`;

export function tissueMaterial(
  look: TissueLook,
  skin: SkinTexture | null,
  pressed: Pressed,
  field: FieldUniforms,
): THREE.MeshPhysicalMaterial {
  const m = new THREE.MeshPhysicalMaterial({
    roughness: 0.62,
    ior: 1.38,
    specularIntensity: 0.6,
    clearcoat: 1,
    clearcoatRoughness: 0.2,
  });
  m.onBeforeCompile = (shader) => {
    if (skin) injectSkinning(shader, skin);
    injectVeil(shader, field);
    shader.uniforms.noise_map = { value: noiseTexture() };
    for (const name of ['crown', 'sulcus', 'deep', 'capillary'] as const)
      shader.uniforms[name] = { value: new THREE.Color(look[name]) };
    shader.uniforms.pressed = { value: pressed };
    shader.uniforms.amounts = { value: new THREE.Vector2(look.capillaries, look.haze) };
    shader.vertexShader = shader.vertexShader
      .replace(
        '#include <common>',
        '#include <common>\nattribute vec2 shading; varying vec2 v_shading; varying vec3 v_rest, v_place;',
      )
      .replace(
        '#include <project_vertex>',
        `#include <project_vertex>
        v_shading = shading; v_rest = position * 1000.0; v_place = (modelMatrix * vec4(transformed, 1.0)).xyz;`,
      );
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', tissueDeclarations)
      .replace('#include <color_fragment>', tissueColour)
      .replace(
        '#include <roughnessmap_fragment>',
        `#include <roughnessmap_fragment>
        roughnessFactor = clamp(roughnessFactor + 0.12 * fine.x, 0.3, 0.9);`,
      )
      .replace(
        '#include <normal_fragment_maps>',
        `#include <normal_fragment_maps>
        vec3 relief = 0.20 * coarse.yzw + 0.18 * middle.yzw + 0.15 * fine.yzw + 0.09 * grain.yzw + 0.30 * ridges;
        normal = bump(normal, normalMatrix * relief);`,
      )
      .replace('#include <clearcoat_normal_fragment_maps>', tissueFilm)
      .replace('#include <lights_physical_fragment>', tissueGloss)
      .replace('#include <lights_fragment_end>', tissueLight);
  };
  m.userData.has_cheap = true;
  m.customProgramCacheKey = () => `tissue_${skin ? 'skinned' : 'static'}`;
  return m;
}

const vesselColour = /* glsl */ `#include <color_fragment>
        vec4 blood = noise(v_rest * 0.8);
        // Thin ones are paler, thick arteries have a whitish coat, thick veins are dark and bluish.
        float thick = v_vessel.z;
        vec3 artery = mix(vec3(0.36, 0.055, 0.042), vec3(0.27, 0.030, 0.026), thick);
        vec3 vein = mix(vec3(0.20, 0.030, 0.042), vec3(0.060, 0.012, 0.034), thick);
        float edge = saturate(dot(normalize(vViewPosition), normalize(vNormal)));
        // The column of blood shows through the middle of the wall, the wall itself at its sides.
        vec3 coat = mix(vec3(0.46, 0.15, 0.12), vec3(0.20, 0.06, 0.09), v_vessel.x);
        vec3 column = mix(artery, vein, v_vessel.x) * (0.85 + 0.35 * blood.x);
        float side = smoothstep(0.75, 0.25, edge) * mix(0.25, 0.6, thick);
        diffuseColor.rgb = mix(column, coat, side) * mix(0.6, 1.15, edge);
        diffuseColor.rgb *= mix(0.35, 1.0, v_vessel.y);`;

/** Small vessels on the brain: wet, dark at the edges as blood absorbs more along the longer path. */
export function vesselMaterial(skin: SkinTexture | null, field: FieldUniforms): THREE.MeshPhysicalMaterial {
  const m = new THREE.MeshPhysicalMaterial({
    color: 0xffffff,
    roughness: 0.42,
    clearcoat: 1,
    clearcoatRoughness: 0.14,
    ior: 1.4,
  });
  m.onBeforeCompile = (shader) => {
    if (skin) injectSkinning(shader, skin);
    // They fill from the large arteries: thinner, later, and the veins hardly.
    injectVeil(shader, field, '0.45 * fluorescence(far_glow * mix(0.7, 0.12, v_vessel.x), edge) * v_vessel.y');
    shader.uniforms.noise_map = { value: noiseTexture() };
    shader.uniforms.far_glow = field.farGlow;
    shader.vertexShader = shader.vertexShader
      .replace(
        '#include <common>',
        '#include <common>\nattribute vec3 vessel; varying vec3 v_vessel; varying vec3 v_rest;',
      )
      .replace(
        '#include <project_vertex>',
        '#include <project_vertex>\nv_vessel = vessel; v_rest = position * 1000.0;',
      );
    shader.fragmentShader = shader.fragmentShader
      .replace(
        '#include <common>',
        `#include <common>\n${noiseGlsl}\n${fluorescenceGlsl}
        uniform float far_glow; varying vec3 v_vessel; varying vec3 v_rest; uniform mat3 normalMatrix;`,
      )
      .replace('#include <color_fragment>', vesselColour)
      .replace(
        '#include <clearcoat_normal_fragment_maps>',
        `#include <clearcoat_normal_fragment_maps>
        #ifdef USE_CLEARCOAT
        clearcoatNormal = bump(clearcoatNormal, normalMatrix * (0.10 * noise(v_rest * 1.4).yzw));
        #endif`,
      )
      .replace(
        '#include <lights_fragment_end>',
        `#include <lights_fragment_end>
        reflectedLight.indirectDiffuse *= v_vessel.y;
        reflectedLight.indirectSpecular *= v_vessel.y;
        #ifdef USE_CLEARCOAT
        clearcoatSpecularIndirect *= v_vessel.y * v_vessel.y;
        clearcoatSpecularDirect *= mix(0.1, 1.0, v_vessel.y);
        #endif`,
      );
  };
  m.userData.has_cheap = true;
  m.customProgramCacheKey = () => `vessel_${skin ? 'skinned' : 'static'}`;
  return m;
}
