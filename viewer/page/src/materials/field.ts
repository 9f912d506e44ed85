// SPDX-License-Identifier: GPL-3.0-or-later
// What lies over everything in the field, whatever its material: fluid that stands in it, the stain it leaves, and the
// microscope's infrared picture. Each material calls veil() with its own light; no depth buffer has to be read back.
import * as THREE from 'three';
import type { FluidLook } from './fluid_look';

/** Below everything: no fluid, no stain. */
export const dryLevel = -1;

export class FieldUniforms {
  /** Unit normal of the fluid's surface and its height over fluidOrigin, m; dryLevel: none. */
  readonly fluidPlane = { value: new THREE.Vector4(0, 0, 1, dryLevel) };
  /** Where heights are counted from, and the radius of the fluid's field, m. */
  readonly fluidOrigin = { value: new THREE.Vector4(0, 0, 0, 0.02) };
  /** Highest level so far, m: what lay under it stays stained. */
  readonly stainLevel = { value: dryLevel };
  /** Where fluid wells up, scene frame; w: how strongly, 0..1. */
  readonly spring = { value: new THREE.Vector4() };
  /** 0 the eye's picture ... 1 the infrared camera's. */
  readonly infrared = { value: 0 };
  readonly seconds = { value: 0 };
  /** Arterial pulse, 0..1. */
  readonly pulse = { value: 0 };
  /** Mean of what shines in the walls' regions: what small vessels of tissue show. */
  readonly farGlow = { value: 0 };
  private readonly absorb = { value: new THREE.Vector3() };
  private readonly scatter = { value: new THREE.Vector3() };
  private readonly stain = { value: new THREE.Vector3(1, 1, 1) };

  setFluid(look: FluidLook): void {
    this.absorb.value.set(...look.absorb);
    this.scatter.value.set(...look.scatter);
    this.stain.value.set(...look.stain);
  }

  bind(shader: THREE.WebGLProgramParametersWithUniforms): void {
    Object.assign(shader.uniforms, {
      fluid_plane: this.fluidPlane,
      fluid_origin: this.fluidOrigin,
      fluid_absorb: this.absorb,
      fluid_scatter: this.scatter,
      fluid_stain: this.stain,
      stain_level: this.stainLevel,
      infrared: this.infrared,
    });
  }
}

/**
 * GLSL of the fragment shader: veil(light, place in view space, glow), where glow is the infrared light the surface
 * emits. Light falls off exponentially along its path through the fluid, each colour by its own rate.
 */
const veilGlsl = /* glsl */ `
uniform vec4 fluid_plane, fluid_origin;
uniform vec3 fluid_absorb, fluid_scatter, fluid_stain;
uniform float stain_level, infrared;
vec3 veil(vec3 light, vec3 place, vec3 glow) {
  vec3 up = mat3(viewMatrix) * fluid_plane.xyz;
  vec3 from = place - (viewMatrix * vec4(fluid_origin.xyz, 1.0)).xyz;
  float rise = dot(from, up);
  float inside = 1.0 - smoothstep(0.92, 1.0, length(from - rise * up) / fluid_origin.w);
  // A stain thins out towards its upper edge.
  float stained = inside * smoothstep(0.0, 0.0015, stain_level - rise);
  light *= mix(vec3(1.0), fluid_stain, stained);
  float under = max(0.0, (fluid_plane.w - rise) / max(0.2, dot(up, -normalize(place)))) * inside;
  vec3 through = exp(-under * fluid_absorb);
  light = light * through + fluid_scatter * (1.0 - through);
  float grey = dot(light, vec3(0.4, 0.4, 0.2));
  vec3 dark = vec3(0.075, 0.098, 0.090) * grey / (1.0 + grey);
  return mix(light, dark + glow * exp(-under * 220.0), infrared);
}
`;

/** Adds the veil to a physical or standard material; `glow`: GLSL expression of its infrared light. */
export function injectVeil(
  shader: THREE.WebGLProgramParametersWithUniforms,
  field: FieldUniforms,
  glow = 'vec3(0.0)',
): void {
  field.bind(shader);
  shader.fragmentShader = shader.fragmentShader
    .replace('#include <common>', `#include <common>\n${veilGlsl}`)
    .replace(
      '#include <opaque_fragment>',
      `outgoingLight = veil(outgoingLight, -vViewPosition, ${glow});\n#include <opaque_fragment>`,
    );
}

/** GLSL: what a near-infrared camera shows of a dye concentration: green, white where it is strong. */
export const fluorescenceGlsl = /* glsl */ `
vec3 fluorescence(float dye, float facing) {
  float d = clamp(dye, 0.0, 1.0);
  return (vec3(0.16, 0.86, 0.42) * d + vec3(0.42, 0.48, 0.40) * d * d) * mix(0.38, 1.0, facing);
}
`;
