// SPDX-License-Identifier: GPL-3.0-or-later
// What lies over everything in the field, whatever its material: blood that stands in it, the stain it leaves, and the
// microscope's infrared picture. Each material calls veil() with its own light; no depth buffer has to be read back.
import * as THREE from 'three';

export const region_capacity = 16;

export class FieldUniforms {
  /** Unit normal of the blood's surface and its height over the bottom, m; height < 0: dry. */
  readonly blood_plane = { value: new THREE.Vector4(0, 0, 1, -1) };
  /** Bottom of the field and its radius, m. */
  readonly blood_field = { value: new THREE.Vector4(0, 0, 0, 0.02) };
  /** Highest level so far, m: what lay under it stays stained. */
  readonly stain_level = { value: -1 };
  /** 0 the eye's picture ... 1 the infrared camera's. */
  readonly infrared = { value: 0 };
  readonly seconds = { value: 0 };
  /** Arterial pulse, 0..1. */
  readonly pulse = { value: 0 };
  /** Concentration of dye in each region of the vessel. */
  readonly dye = { value: new Float32Array(region_capacity) };
  /** Of the branches that leave the field: what surface vessels show. */
  readonly dye_far = { value: 0 };

  bind(shader: THREE.WebGLProgramParametersWithUniforms): void {
    Object.assign(shader.uniforms, {
      blood_plane: this.blood_plane, blood_field: this.blood_field, stain_level: this.stain_level, infrared: this.infrared,
    });
  }
}

/**
 * GLSL of the fragment shader: veil(light, place in view space, glow), where glow is the infrared light the surface emits.
 * Whole blood lets red through for a millimetre or two, green and blue for a fraction of one.
 */
const veil_glsl = /* glsl */ `
uniform vec4 blood_plane, blood_field;
uniform float stain_level, infrared;
vec3 veil(vec3 light, vec3 place, vec3 glow) {
  vec3 up = mat3(viewMatrix) * blood_plane.xyz;
  vec3 from = place - (viewMatrix * vec4(blood_field.xyz, 1.0)).xyz;
  float rise = dot(from, up);
  float inside = 1.0 - smoothstep(0.92, 1.0, length(from - rise * up) / blood_field.w);
  // A stain thins out towards its upper edge.
  float stained = inside * smoothstep(0.0, 0.0015, stain_level - rise);
  light *= mix(vec3(1.0), vec3(0.80, 0.40, 0.36), stained);
  float under = (blood_plane.w - rise) / max(0.2, dot(up, -normalize(place)));
  under = max(0.0, under) * inside * step(0.0, blood_plane.w);
  vec3 through = exp(-under * vec3(850.0, 5200.0, 4600.0));
  light = light * through + vec3(0.094, 0.0022, 0.0020) * (1.0 - through);
  float grey = dot(light, vec3(0.4, 0.4, 0.2));
  vec3 dark = vec3(0.075, 0.098, 0.090) * grey / (1.0 + grey);
  return mix(light, dark + glow * exp(-under * 220.0), infrared);
}
`;

/** Adds the veil to a physical or standard material; `glow`: GLSL expression of its infrared light. */
export function inject_veil(shader: THREE.WebGLProgramParametersWithUniforms, field: FieldUniforms, glow = 'vec3(0.0)'): void {
  field.bind(shader);
  shader.fragmentShader = shader.fragmentShader
    .replace('#include <common>', `#include <common>\n${veil_glsl}`)
    .replace('#include <opaque_fragment>', `outgoingLight = veil(outgoingLight, -vViewPosition, ${glow});\n#include <opaque_fragment>`);
}

/** GLSL: what a near-infrared camera shows of a dye concentration: green, white where it is strong. */
export const fluorescence_glsl = /* glsl */ `
vec3 fluorescence(float dye, float facing) {
  float d = clamp(dye, 0.0, 1.0);
  return (vec3(0.16, 0.86, 0.42) * d + vec3(0.42, 0.48, 0.40) * d * d) * mix(0.38, 1.0, facing);
}
`;
