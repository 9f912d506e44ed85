// SPDX-License-Identifier: GPL-3.0-or-later
// The style "wall" of hollow organs: wet, pinkish, with fine vessels and yellow plaques in its coat; where it is thin
// the dark fluid inside shows through and swirls. What hangs empty is pale, dark in its folds, and dull. In the
// infrared picture a wall shines with the value of its region.
import * as THREE from 'three';
import { injectSkinning, type SkinTexture } from '../skin_shader';
import { fluorescenceGlsl, type FieldUniforms, injectVeil } from './field';
import { noiseGlsl, noiseTexture } from './noise';

/** Regions whose values a wall can show. */
export const regionCapacity = 16;

const wallColour = /* glsl */ `#include <color_fragment>
        float facing = saturate(dot(normalize(vViewPosition), normalize(vNormal)));
        vec4 broad = noise(v_rest * 0.33);
        vec4 middle = noise(v_rest * 1.05);
        float thin = v_wall.y;
        // Coat: muscle under whitish fibres.
        float pale = smoothstep(-0.5, 0.6, broad.x + 0.35 * middle.x);
        vec3 coat = mix(vec3(0.36, 0.034, 0.030), vec3(0.50, 0.098, 0.078), pale);
        #ifndef CHEAP
        vec4 fine = noise(v_rest * 3.1);
        float vasa = 1.0 - smoothstep(0.0, 0.075, abs(noise(v_rest * 0.62 + middle.yzw * 0.55).x));
        vasa *= smoothstep(-0.15, 0.35, noise(v_rest * 0.27 + 4.0).x);
        coat *= 1.0 + 0.10 * fine.x;
        coat = mix(coat, vec3(0.30, 0.022, 0.020), 0.62 * vasa * (1.0 - 0.4 * thin));
        // Blood under the thin wall, seen a little below the surface: it turns with the jet that comes in at the neck.
        vec3 inward = normalize(v_place - cameraPosition) * 1.1;
        vec3 q = (v_rest + inward) * 0.34;
        float turn = seconds * 0.55;
        vec3 drift = noise(q * 0.8 + vec3(0.0, turn * 0.5, turn * 0.3)).yzw;
        float swirl = noise(q * 1.5 + drift * 1.3 - vec3(turn * 0.6, 0.0, turn * 0.35)).x;
        swirl = smoothstep(-0.55, 0.6, swirl + 0.25 * (pulse - 0.4));
        // Atheroma: yellow patches with soft borders in the thick coat.
        float fat = noise(v_rest * 0.30 + 31.0).x + 0.35 * noise(v_rest * 0.8 + 13.0).x;
        fat = smoothstep(0.40, 0.85, fat) * (1.0 - smoothstep(0.1, 0.6, thin));
        coat = mix(coat, vec3(0.50, 0.24, 0.10) * (1.0 + 0.14 * fine.x), 0.5 * fat);
        #else
        float swirl = 0.5 + 0.4 * broad.x;
        #endif
        // Blood that stays behind gives off its oxygen and sets.
        float stale = 1.0 - v_full;
        swirl = mix(swirl, 0.18 + 0.15 * middle.x, stale);
        vec3 blood = mix(vec3(0.070, 0.0028, 0.0065), vec3(0.29, 0.013, 0.011), swirl);
        blood = mix(blood, vec3(0.036, 0.008, 0.016), 0.85 * stale);
        // An empty wall lies in folds, pale on their crests.
        float crease = noise(v_rest * vec3(0.9, 1.6, 1.2) + 3.0 * broad.yzw).x;
        vec3 drained = mix(vec3(0.33, 0.17, 0.16), vec3(0.48, 0.30, 0.27), smoothstep(-0.4, 0.6, crease));
        coat = mix(coat, drained, 0.75 * stale);
        // The path through blood is longest in the middle, the wall looks thickest at the edge.
        float through = thin * mix(0.55, 1.0, smoothstep(0.1, 0.9, facing));
        // Plaque: pale, opaque islands in the thin wall.
        float plaque = smoothstep(0.30, 0.62, noise(v_rest * 0.42 + 9.0).x + 0.3 * middle.x);
        plaque *= smoothstep(0.25, 0.55, thin) * (1.0 - smoothstep(0.85, 1.0, thin));
        coat = mix(coat, vec3(0.66, 0.40, 0.25), 0.6 * plaque);
        through *= 1.0 - 0.75 * plaque;
        through *= 1.0 - 0.30 * stale * smoothstep(-0.5, 0.5, crease);
        vec3 tint = mix(coat, blood, through);
        tint *= mix(0.62, 1.12, facing);
        diffuseColor.rgb = tint * mix(0.30, 1.0, v_wall.x);`;

const wallLight = /* glsl */ `#include <lights_fragment_end>
        // Light that entered comes out again red where the wall is thin.
        vec3 back = diffuseColor.rgb * vec3(0.30, 0.05, 0.04) + vec3(0.030, 0.0012, 0.0010) * thin;
        reflectedLight.indirectDiffuse += back * v_wall.x;
        reflectedLight.indirectDiffuse *= v_wall.x;
        reflectedLight.indirectSpecular *= v_wall.x;
        #ifdef USE_CLEARCOAT
        clearcoatSpecularIndirect *= v_wall.x * v_wall.x;
        clearcoatSpecularDirect *= mix(0.15, 1.0, v_wall.x);
        #endif`;

const wallVaryings = /* glsl */ `#include <project_vertex>
        int r = int(region + 0.5);
        v_wall = wall; v_glow = region_value[r]; v_full = region_full[r]; v_rest = position * 1000.0;
        v_place = (modelMatrix * vec4(transformed, 1.0)).xyz;`;

const wallNormal = /* glsl */ `#include <normal_fragment_maps>
        vec3 folds = noise(v_rest * vec3(0.9, 1.6, 1.2) + 3.0 * broad.yzw).yzw;
        vec3 relief = (0.13 * middle.yzw) * (1.0 - 0.6 * v_wall.y) + 0.55 * folds * (1.0 - v_full);
        normal = bump(normal, normalMatrix * relief);`;

const wallGloss = /* glsl */ `#include <lights_physical_fragment>
        // What hangs empty dries and dulls.
        #ifdef USE_CLEARCOAT
        material.clearcoat *= mix(0.25, 1.0, v_full);
        material.clearcoatRoughness = mix(0.5, material.clearcoatRoughness, v_full);
        #endif
        material.roughness = mix(0.85, material.roughness, v_full);`;

const wallFilm = /* glsl */ `#include <clearcoat_normal_fragment_maps>
        #ifdef USE_CLEARCOAT
        vec3 wave = 0.05 * broad.yzw + 0.035 * middle.yzw + 0.4 * folds * (1.0 - v_full);
        clearcoatNormal = bump(clearcoatNormal, normalMatrix * wave);
        #endif`;

const wallDeclarations = /* glsl */ `#include <common>
        ${noiseGlsl}
        ${fluorescenceGlsl}
        varying vec2 v_wall; varying float v_glow, v_full; varying vec3 v_rest, v_place;
        uniform mat3 normalMatrix; uniform float seconds, pulse;`;

/**
 * Vertex attributes: `wall` = (openness 0..1, thinness 0..1), `region` = index into `values` and `filling` (0..1 each;
 * filling 0: the region hangs empty).
 */
export function wallMaterial(
  skin: SkinTexture | null,
  field: FieldUniforms,
  values: { value: Float32Array },
  filling: { value: Float32Array },
): THREE.MeshPhysicalMaterial {
  const m = new THREE.MeshPhysicalMaterial({
    roughness: 0.46,
    clearcoat: 1,
    clearcoatRoughness: 0.12,
    ior: 1.4,
    specularIntensity: 0.6,
  });
  m.onBeforeCompile = (shader) => {
    if (skin) injectSkinning(shader, skin);
    injectVeil(shader, field, 'fluorescence(v_glow, saturate(dot(normalize(vViewPosition), normalize(vNormal))))');
    Object.assign(shader.uniforms, {
      noise_map: { value: noiseTexture() },
      region_value: values,
      region_full: filling,
      seconds: field.seconds,
      pulse: field.pulse,
    });
    shader.vertexShader = shader.vertexShader
      .replace(
        '#include <common>',
        `#include <common>
        attribute vec2 wall; attribute float region;
        uniform float region_value[${regionCapacity}];
        uniform float region_full[${regionCapacity}];
        varying vec2 v_wall; varying float v_glow, v_full; varying vec3 v_rest, v_place;`,
      )
      .replace('#include <project_vertex>', wallVaryings);
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', wallDeclarations)
      .replace('#include <color_fragment>', wallColour)
      .replace('#include <normal_fragment_maps>', wallNormal)
      .replace('#include <lights_physical_fragment>', wallGloss)
      .replace('#include <clearcoat_normal_fragment_maps>', wallFilm)
      .replace('#include <lights_fragment_end>', wallLight);
  };
  m.customProgramCacheKey = () => `wall_${skin ? 'skinned' : 'static'}`;
  m.userData.has_cheap = true;
  return m;
}
