// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of a fluid in the field: what it reflects, streaks of what has just come in, and clots where it stands
// still (what lies below is tinted by each material's veil). Gentle waves, rings around the place where it wells up, in
// step with the pulse.
import * as THREE from 'three';
import type { FieldUniforms } from './field';
import { noiseGlsl, noiseTexture } from './noise';

const fluidDeclarations = /* glsl */ `#include <common>
        ${noiseGlsl}
        varying vec2 v_disc; varying vec3 v_place;
        uniform mat3 normalMatrix; uniform float seconds, pulse, infrared, clotted; uniform vec4 spring;
        uniform vec3 body_colour; uniform float murk;
        // Gradient of the surface's height, in the scene.
        vec3 waves() {
          vec3 p = v_place * 1000.0;
          vec3 g = 0.08 * noise(p * 0.16 + vec3(0.0, 0.0, seconds * 0.35)).yzw;
          g += 0.05 * noise(p * 0.42 + vec3(seconds * 0.5, 0.0, -seconds * 0.4)).yzw;
          #ifndef CHEAP
          g += 0.015 * noise(p * 1.3 - vec3(seconds * 0.7)).yzw;
          #endif
          vec3 away = p - spring.xyz * 1000.0;
          float d = length(away) + 0.05;
          float ring = sin(d * 2.1 - seconds * 11.0) * exp(-d * 0.22) + 1.6 * exp(-d * d * 0.16) * (0.4 + pulse);
          return g + away / d * ring * 0.20 * spring.w;
        }
        // x: share of the surface that has set here, y: edge of a clot.
        vec2 clot(vec3 p) {
          float n = noise(p * 0.21 + 5.0).x + 0.45 * noise(p * 0.55).x + 0.2 * noise(p * 1.9).x;
          // It sets from the rim inwards, and not where fluid wells up.
          float away = distance(p, spring.xyz * 1000.0);
          n += 0.7 * length(v_disc) - 0.35 - 2.5 * spring.w * exp(-away * away * 0.02);
          float set = smoothstep(0.75 - 1.1 * clotted, 0.95 - 1.1 * clotted, n);
          return vec2(set, set * (1.0 - set) * 4.0) * step(0.001, clotted);
        }`;

const fluidOutput = /* glsl */ `
        float edge = 1.0 - smoothstep(0.90, 0.995, length(v_disc));
        float seen = saturate(dot(normalize(vViewPosition), normal));
        float cover = 0.10 + 0.60 * pow(1.0 - seen, 4.0);
        // What shines through the mirror's own darkness is left to the liquid below.
        vec3 shine = min(0.42 * outgoingLight, vec3(0.7));
        float light = 1.0 - 0.97 * infrared;
        // Fresh fluid is brighter than what has lain there; it drifts away in streaks.
        vec3 p = v_place * 1000.0;
        vec3 from_spring = p - spring.xyz * 1000.0;
        float near_spring = exp(-dot(from_spring, from_spring) * 0.03) * spring.w;
        vec4 broad = noise(p * 0.13 + vec3(seconds * 0.05, 0.0, seconds * 0.04));
        float streak = noise(p * 0.32 + broad.yzw * 2.2 + vec3(0.0, seconds * 0.09, 0.0)).x;
        streak = smoothstep(-0.25, 0.55, streak + 1.6 * near_spring);
        float lit = 0.35 + 0.65 * seen;
        vec3 body = body_colour * mix(0.65, 1.45, streak) * lit;
        float opaque = 0.62 * murk;
        vec2 set = clot(p);
        vec3 dark = body_colour * vec3(0.34, 0.5, 0.6) * (0.75 + 0.5 * noise(p * 2.3).x) * lit;
        body = mix(body, dark, set.x);
        opaque = mix(opaque, 0.93, set.x) * light;
        shine *= 1.0 - 0.62 * set.x;
        float alpha = max(0.35 * cover, opaque);
        gl_FragColor = vec4(shine * light + body * opaque, alpha) * edge;`;

export interface FluidSurface {
  /** Linear light of a deep pool. */
  body: readonly [number, number, number];
  /** 0 clear ... 1: the surface itself hides what lies below. */
  murk: number;
  /** 0..1: how much of the surface has set. */
  clotted: { value: number };
}

export function fluidMaterial(
  field: FieldUniforms,
  environment: THREE.Texture | null,
  surface: FluidSurface,
): THREE.MeshPhysicalMaterial {
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
      clotted: surface.clotted,
      body_colour: { value: new THREE.Vector3(...surface.body) },
      murk: { value: surface.murk },
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
        `#include <normal_fragment_maps>
        // A clot is rough and does not flow.
        vec2 crust = clot(v_place * 1000.0);
        vec3 rough = noise(v_place * 1900.0).yzw + 0.7 * noise(v_place * 700.0).yzw;
        vec3 tilt = mat3(viewMatrix) * (waves() * (1.0 - 0.8 * crust.x) + 0.5 * rough * crust.x);
        normal = bump(normal, tilt);`,
      )
      .replace(
        '#include <clearcoat_normal_fragment_maps>',
        '#ifdef USE_CLEARCOAT\nclearcoatNormal = bump(clearcoatNormal, tilt);\n#endif',
      )
      .replace('#include <opaque_fragment>', fluidOutput)
      .replace('#include <premultiplied_alpha_fragment>', '');
  };
  m.customProgramCacheKey = () => 'fluid';
  m.userData.has_cheap = true;
  return m;
}
