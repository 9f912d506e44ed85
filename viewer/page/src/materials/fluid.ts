// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of a fluid in the field: only what it reflects is drawn here (what lies below is tinted by each
// material's veil). Gentle waves, rings around the place where it wells up, in step with the pulse.
import * as THREE from 'three';
import type { FieldUniforms } from './field';
import { noiseGlsl, noiseTexture } from './noise';

const fluidDeclarations = /* glsl */ `#include <common>
        ${noiseGlsl}
        varying vec2 v_disc; varying vec3 v_place;
        uniform mat3 normalMatrix; uniform float seconds, pulse, infrared; uniform vec4 spring;
        // Gradient of the surface's height, in the scene.
        vec3 waves() {
          vec3 p = v_place * 1000.0;
          vec3 g = 0.14 * noise(p * 0.16 + vec3(0.0, 0.0, seconds * 0.35)).yzw;
          g += 0.13 * noise(p * 0.42 + vec3(seconds * 0.5, 0.0, -seconds * 0.4)).yzw;
          #ifndef CHEAP
          g += 0.03 * noise(p * 1.3 - vec3(seconds * 0.7)).yzw;
          #endif
          vec3 away = p - spring.xyz * 1000.0;
          float d = length(away) + 0.05;
          float ring = sin(d * 2.1 - seconds * 11.0) * exp(-d * 0.22) + 1.6 * exp(-d * d * 0.16) * (0.4 + pulse);
          return g + away / d * ring * 0.20 * spring.w;
        }`;

const fluidOutput = /* glsl */ `
        float edge = 1.0 - smoothstep(0.90, 0.995, length(v_disc));
        float seen = saturate(dot(normalize(vViewPosition), normal));
        float cover = 0.10 + 0.60 * pow(1.0 - seen, 4.0);
        // What shines through the mirror's own darkness is left to the liquid below.
        gl_FragColor = vec4(min(0.42 * outgoingLight, vec3(0.7)) * (1.0 - 0.97 * infrared), 0.35 * cover) * edge;`;

export function fluidMaterial(field: FieldUniforms, environment: THREE.Texture | null): THREE.MeshPhysicalMaterial {
  const m = new THREE.MeshPhysicalMaterial({
    color: 0x000000,
    roughness: 0.3,
    clearcoat: 0.8,
    clearcoatRoughness: 0.1,
    ior: 1.36,
    specularIntensity: 0,
    envMapIntensity: 0.06,
    transparent: true,
    depthWrite: false,
    premultipliedAlpha: true,
  });
  // Its own copy of the room: a flat pool would throw the whole lamp ring back at once.
  m.envMap = environment;
  m.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, {
      noise_map: { value: noiseTexture() },
      seconds: field.seconds,
      pulse: field.pulse,
      infrared: field.infrared,
      spring: field.spring,
    });
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nvarying vec2 v_disc; varying vec3 v_place;')
      .replace(
        '#include <project_vertex>',
        '#include <project_vertex>\nv_disc = position.xy; v_place = (modelMatrix * vec4(transformed, 1.0)).xyz;',
      );
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', fluidDeclarations)
      .replace(
        '#include <normal_fragment_maps>',
        '#include <normal_fragment_maps>\nvec3 tilt = mat3(viewMatrix) * waves();\nnormal = bump(normal, tilt);',
      )
      .replace('#include <clearcoat_normal_fragment_maps>', 'clearcoatNormal = bump(clearcoatNormal, tilt);')
      .replace('#include <opaque_fragment>', fluidOutput)
      .replace('#include <premultiplied_alpha_fragment>', '');
  };
  m.customProgramCacheKey = () => 'fluid';
  m.userData.has_cheap = true;
  return m;
}
