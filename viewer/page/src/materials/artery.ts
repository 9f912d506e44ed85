// SPDX-License-Identifier: GPL-3.0-or-later
// The wall of a large artery: wet, pinkish, with fine vessels in its coat; where it is thin (sac, bleb) the dark blood shows
// through and swirls. In the infrared picture it shines with the dye of its region.
import * as THREE from 'three';
import { inject_skinning, type SkinTexture } from '../skin_shader';
import { fluorescence_glsl, type FieldUniforms, inject_veil, region_capacity } from './field';
import { noise_glsl, noise_texture } from './noise';

/** Vertex attributes: `wall` = (openness 0..1, thinness 0..1), `region` = index of its dye. */
export function artery_material(skin: SkinTexture | null, field: FieldUniforms): THREE.MeshPhysicalMaterial {
  const m = new THREE.MeshPhysicalMaterial({ color: 0xffffff, roughness: 0.46, clearcoat: 1, clearcoatRoughness: 0.12, ior: 1.4, specularIntensity: 0.6 });
  m.onBeforeCompile = (shader) => {
    if (skin) inject_skinning(shader, skin);
    inject_veil(shader, field, 'fluorescence(v_dye, saturate(dot(normalize(vViewPosition), normalize(vNormal))))');
    Object.assign(shader.uniforms, { noise_map: { value: noise_texture() }, dye: field.dye, seconds: field.seconds, pulse: field.pulse });
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `#include <common>
        attribute vec2 wall; attribute float region;
        uniform float dye[${region_capacity}];
        varying vec2 v_wall; varying float v_dye; varying vec3 v_rest, v_place;`)
      .replace('#include <project_vertex>', `#include <project_vertex>
        v_wall = wall; v_dye = dye[int(region + 0.5)]; v_rest = position * 1000.0; v_place = (modelMatrix * vec4(transformed, 1.0)).xyz;`);
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', `#include <common>
        ${noise_glsl}
        ${fluorescence_glsl}
        varying vec2 v_wall; varying float v_dye; varying vec3 v_rest, v_place;
        uniform mat3 normalMatrix; uniform float seconds, pulse;`)
      .replace('#include <color_fragment>', `#include <color_fragment>
        float facing = saturate(dot(normalize(vViewPosition), normalize(vNormal)));
        vec4 broad = noise(v_rest * 0.33);
        vec4 middle = noise(v_rest * 1.05);
        float thin = v_wall.y;
        // Coat: muscle under whitish fibres.
        vec3 coat = mix(vec3(0.36, 0.034, 0.030), vec3(0.50, 0.098, 0.078), smoothstep(-0.5, 0.6, broad.x + 0.35 * middle.x));
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
        #else
        float swirl = 0.5 + 0.4 * broad.x;
        #endif
        vec3 blood = mix(vec3(0.070, 0.0028, 0.0065), vec3(0.29, 0.013, 0.011), swirl);
        // The path through blood is longest in the middle, the wall looks thickest at the edge.
        float through = thin * mix(0.55, 1.0, smoothstep(0.1, 0.9, facing));
        // Plaque: pale, opaque islands in the thin wall.
        float plaque = smoothstep(0.30, 0.62, noise(v_rest * 0.42 + 9.0).x + 0.3 * middle.x) * smoothstep(0.25, 0.55, thin) * (1.0 - smoothstep(0.85, 1.0, thin));
        coat = mix(coat, vec3(0.66, 0.40, 0.25), 0.6 * plaque);
        through *= 1.0 - 0.75 * plaque;
        vec3 tint = mix(coat, blood, through);
        tint *= mix(0.62, 1.12, facing);
        diffuseColor.rgb = tint * mix(0.30, 1.0, v_wall.x);`)
      .replace('#include <normal_fragment_maps>', `#include <normal_fragment_maps>
        normal = bump(normal, normalMatrix * ((0.13 * middle.yzw) * (1.0 - 0.6 * v_wall.y)));`)
      .replace('#include <clearcoat_normal_fragment_maps>', `#include <clearcoat_normal_fragment_maps>
        clearcoatNormal = bump(clearcoatNormal, normalMatrix * (0.05 * broad.yzw + 0.035 * middle.yzw));`)
      .replace('#include <lights_fragment_end>', `#include <lights_fragment_end>
        // Light that entered comes out again red where the wall is thin.
        reflectedLight.indirectDiffuse += diffuseColor.rgb * vec3(0.30, 0.05, 0.04) * v_wall.x + vec3(0.030, 0.0012, 0.0010) * thin * v_wall.x;
        reflectedLight.indirectDiffuse *= v_wall.x;
        reflectedLight.indirectSpecular *= v_wall.x;
        clearcoatSpecularIndirect *= v_wall.x * v_wall.x;
        clearcoatSpecularDirect *= mix(0.15, 1.0, v_wall.x);`);
  };
  m.customProgramCacheKey = () => `artery_${skin ? 'skinned' : 'static'}`;
  m.userData.has_cheap = true;
  return m;
}
