// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that is not brain: bone, dura, drape, instrument metals and plastics.
import * as THREE from 'three';
import { type FieldUniforms, injectVeil } from './field';
import { injectSkinning, type SkinTexture } from '../skin_shader';
import { noiseGlsl, noiseTexture } from './noise';

interface Recipe {
  base: THREE.MeshPhysicalMaterialParameters;
  /** GLSL run after the base colour is known: may change diffuseColor; p is the position in millimetres. */
  colour: string;
  /** GLSL expression of the normal's tilt (object space). */
  relief: string;
  /** Metal: how much it mirrors; lamps are rolled off, or a blade that faces them would be a white card. */
  metal?: number;
}

/**
 * Lamps in metal end below white, and differences between dim parts of the reflection are kept. What turns away mirrors
 * the dark behind the lamps: that edge is what tells metal from plastic.
 */
const rollOff = (share: number) => `
  float turned = 1.0 - saturate(dot(normalize(vViewPosition), normal));
  vec3 shine = ${share.toFixed(2)} * (0.04 * reflectedLight.directSpecular + reflectedLight.indirectSpecular);
  shine *= mix(1.12, 0.30, turned * turned);
  reflectedLight.directSpecular = vec3(0.0);
  reflectedLight.indirectSpecular = shine / (1.0 + 1.2 * max(shine.r, max(shine.g, shine.b)));`;

const recipes: Record<string, Recipe> = {
  bone: {
    base: { color: '#bba684', roughness: 0.62, clearcoat: 0.35, clearcoatRoughness: 0.35 },
    colour: `
      vec4 a = noise(p * 0.22), b = noise(p * 1.3), c = noise(p * 3.4);
      // Cut edge: the spongy layer between the tables, red marrow in its pores.
      float cut = 1.0 - smoothstep(0.25, 0.65, abs(dot(normalize(v_object_normal), field_axis)));
      float pores = smoothstep(0.10, 0.50, b.x + 0.35 * c.x);
      diffuseColor.rgb *= 1.0 + 0.10 * a.x + 0.05 * b.x;
      diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.42, 0.10, 0.06), cut * (0.18 + 0.60 * pores));
      // A film of blood left on the outer table.
      float film = 0.55 * smoothstep(0.05, 0.65, a.x + 0.3 * b.x);
      diffuseColor.rgb = mix(diffuseColor.rgb, diffuseColor.rgb * vec3(0.95, 0.60, 0.50), film);`,
    relief: '0.10 * noise(p * 1.3).yzw + 0.12 * noise(p * 3.4).yzw',
  },
  dura: {
    base: { color: '#a87b6b', roughness: 0.5, clearcoat: 0.8, clearcoatRoughness: 0.22, side: THREE.DoubleSide },
    colour: `
      vec4 a = noise(p * vec3(0.25, 0.9, 0.5)), b = noise(p * vec3(0.7, 2.6, 1.4));
      diffuseColor.rgb *= 1.0 + 0.10 * a.x + 0.08 * b.x;
      float line = 1.0 - smoothstep(0.0, 0.05, abs(noise(p * 0.20 + a.yzw * 0.35).x));
      line *= smoothstep(0.0, 0.5, noise(p * 0.11 + 2.0).x);
      diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.34, 0.06, 0.05), 0.45 * line);
      float flush = 0.35 * smoothstep(0.2, 0.8, noise(p * 0.15 + 4.0).x);
      diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.50, 0.16, 0.13), flush);`,
    relief: '0.16 * noise(p * vec3(0.25, 0.9, 0.5)).yzw + 0.12 * noise(p * vec3(0.7, 2.6, 1.4)).yzw',
  },
  drape: {
    base: {
      color: '#1e5b55',
      roughness: 0.92,
      sheen: 0.4,
      sheenRoughness: 0.6,
      sheenColor: new THREE.Color('#3f8a82'),
      side: THREE.DoubleSide,
    },
    colour: `
      vec4 a = noise(p * 0.12);
      vec2 weave = sin(vec2(dot(p, vec3(1.0, 0.35, -0.2)), dot(p, vec3(-0.3, 0.9, 0.55))) * 9.0);
      diffuseColor.rgb *= 0.95 + 0.12 * a.x + 0.07 * weave.x * weave.y;
      // Damp near the wound.
      diffuseColor.rgb *= 0.80 + 0.20 * smoothstep(-0.4, 0.5, a.x);`,
    relief: '0.22 * noise(p * 0.12).yzw + 0.10 * noise(p * 0.45).yzw + 0.10 * noise(p * 4.0).yzw',
  },
  skin: {
    base: { color: '#c08a6c', roughness: 0.6, clearcoat: 0.3, clearcoatRoughness: 0.4 },
    colour: `
      vec4 a = noise(p * 0.3), b = noise(p * 2.2);
      diffuseColor.rgb *= 1.0 + 0.10 * a.x + 0.08 * b.x;
      // The cut edge shows fat and blood, the surface the iodine it was painted with.
      float cut = 1.0 - smoothstep(0.25, 0.7, abs(dot(normalize(v_object_normal), field_axis)));
      float meat = smoothstep(-0.2, 0.4, noise(p * 0.7).x);
      vec3 inside = mix(vec3(0.62, 0.36, 0.10), vec3(0.36, 0.05, 0.03), meat);
      diffuseColor.rgb = mix(diffuseColor.rgb, inside, cut);`,
    relief: '0.14 * noise(p * 0.9).yzw + 0.14 * noise(p * 2.2).yzw',
  },
  steel: {
    base: { color: '#d3d6da', metalness: 1, roughness: 0.22, envMapIntensity: 1.25 },
    colour: 'diffuseColor.rgb *= 0.97 + 0.05 * noise(p * 0.6).x;',
    // Brushed along the shaft.
    relief: '0.05 * noise(p * 0.11).yzw + 0.03 * noise(p * vec3(13.0, 13.0, 0.3)).yzw',
    metal: 0.6,
  },
  steel_dark: {
    base: { color: '#85888e', metalness: 1, roughness: 0.36, envMapIntensity: 1.2 },
    colour: 'diffuseColor.rgb *= 0.95 + 0.08 * noise(p * 0.6).x;',
    relief: '0.03 * noise(p * vec3(5.0, 5.0, 0.5)).yzw',
    metal: 0.6,
  },
  // Clips: satin, a little warmer and darker than steel.
  titanium: {
    base: { color: '#a5a6ab', metalness: 1, roughness: 0.28, envMapIntensity: 1.35 },
    colour: 'diffuseColor.rgb *= 0.96 + 0.07 * noise(p * 1.2).x;',
    relief: '0.025 * noise(p * vec3(6.0, 6.0, 1.5)).yzw',
    metal: 0.8,
  },
  // A cottonoid: felt that has soaked up what lies around it.
  cotton: {
    base: { color: '#cfc4b6', roughness: 0.95, clearcoat: 0.35, clearcoatRoughness: 0.55 },
    colour: `
      vec4 a = noise(p * 0.5), b = noise(p * 2.4);
      diffuseColor.rgb *= 0.9 + 0.12 * a.x + 0.10 * b.x;
      float soaked = smoothstep(-0.1, 0.7, a.x + 0.3 * b.x);
      diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.42, 0.09, 0.07), 0.55 * soaked);`,
    relief: '0.35 * noise(p * 1.6).yzw + 0.35 * noise(p * 4.2).yzw',
  },
  polymer: {
    base: { color: '#20242b', roughness: 0.5, clearcoat: 0.25, clearcoatRoughness: 0.4 },
    colour: '',
    relief: '0.02 * noise(p * 3.0).yzw',
  },
  gold: {
    base: { color: '#e0b45c', metalness: 1, roughness: 0.2, envMapIntensity: 1.6 },
    colour: '',
    relief: '0.012 * noise(p * vec3(5.0, 5.0, 0.5)).yzw',
    metal: 1,
  },
};

export const solidNames = Object.keys(recipes);

/** What is cut into an instrument, along its own z axis from its tip. */
export type Engraving = 'none' | 'graduated' | 'serrated';

/** GLSL: may change diffuseColor; p is the position in millimetres. */
const engravings: Record<Engraving, string> = {
  none: '',
  // A ring each 5 mm, a double one each 10 mm: the shaft is the ruler.
  graduated: `
    float width = max(0.16, 0.6 * fwidth(p.z));
    float five = abs(mod(p.z + 2.5, 5.0) - 2.5), second = abs(mod(p.z - 0.7 + 5.0, 10.0) - 5.0);
    float ring = max(1.0 - smoothstep(width, 1.6 * width, five), 1.0 - smoothstep(width, 1.6 * width, second));
    ring *= step(2.5, p.z) * (1.0 - step(42.0, p.z));
    diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.03), 0.85 * ring);`,
  // Teeth of a jaw, finer than a pixel from afar.
  serrated: `
    float tooth = 0.5 + 0.5 * sin(p.z * 15.7);
    float near = 1.0 - smoothstep(0.08, 0.22, fwidth(p.z));
    float face = smoothstep(0.5, 0.8, abs(v_object_normal.x));
    diffuseColor.rgb *= 1.0 - 0.45 * near * face * smoothstep(0.35, 0.9, tooth);`,
};

export interface SolidOptions {
  field: FieldUniforms;
  /** Of a material that has no texture here; else a polymer's colour. */
  rgba?: readonly number[];
  roughness?: number;
  metalness?: number;
  /** Direction out of the operating field, to tell tables of bone from cut edges. */
  fieldAxis?: THREE.Vector3;
  /** So much nearer to the eye, m, when it is decided what hides what. */
  forward?: { value: number };
  skin?: SkinTexture | null;
  engraving?: Engraving;
}

/** A material that only its declaration describes. */
function plainRecipe(o: SolidOptions): Recipe {
  const metalness = o.metalness ?? 0;
  const base = { roughness: o.roughness ?? 0.5, metalness, clearcoat: 0.2 * (1 - metalness), clearcoatRoughness: 0.4 };
  return {
    base: { ...base, side: o.skin ? THREE.DoubleSide : THREE.FrontSide },
    colour: '',
    relief: 'vec3(0.0)',
    ...(metalness > 0.5 ? { metal: 0.6 } : {}),
  };
}

export function solidMaterial(name: string, o: SolidOptions): THREE.MeshPhysicalMaterial {
  // What nothing declares is metal, as instruments are.
  const recipe = recipes[name] ?? (o.roughness === undefined ? recipes.steel! : plainRecipe(o));
  const m = new THREE.MeshPhysicalMaterial(recipe.base);
  if ((name === 'polymer' || !recipes[name]) && o.rgba)
    m.color.setRGB(o.rgba[0]!, o.rgba[1]!, o.rgba[2]!, THREE.SRGBColorSpace);
  m.onBeforeCompile = (shader) => {
    if (o.skin) injectSkinning(shader, o.skin);
    injectVeil(shader, o.field);
    shader.uniforms.noise_map = { value: noiseTexture() };
    shader.uniforms.field_axis = { value: o.fieldAxis ?? new THREE.Vector3(0, 0, 1) };
    shader.uniforms.forward_m = o.forward ?? { value: 0 };
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `#include <common>\n${varyings} uniform float forward_m;`)
      .replace(
        '#include <project_vertex>',
        `#include <project_vertex>
        v_object = position * 1000.0; v_object_normal = normal;
        vec4 nearer = projectionMatrix * (mvPosition + vec4(0.0, 0.0, forward_m, 0.0));
        if (forward_m > 0.0) gl_Position.z = nearer.z / nearer.w * gl_Position.w;`,
      );
    shader.fragmentShader = shader.fragmentShader
      .replace(
        '#include <common>',
        `#include <common>\n${noiseGlsl}\n${varyings} uniform vec3 field_axis; uniform mat3 normalMatrix;`,
      )
      .replace(
        '#include <color_fragment>',
        `#include <color_fragment>\nvec3 p = v_object;\n{${recipe.colour}${engravings[o.engraving ?? 'none']}}`,
      )
      .replace(
        '#include <normal_fragment_maps>',
        `#include <normal_fragment_maps>\nnormal = bump(normal, normalMatrix * (${recipe.relief}));`,
      );
    if (recipe.metal)
      shader.fragmentShader = shader.fragmentShader.replace(
        '#include <lights_fragment_end>',
        `#include <lights_fragment_end>${rollOff(recipe.metal)}`,
      );
  };
  m.userData.has_cheap = m.clearcoat > 0;
  m.customProgramCacheKey = () =>
    `solid_${recipes[name] ? name : `plain_${recipe.metal ?? 0}`}_${o.skin ? 'skinned' : ''}_${o.engraving ?? ''}`;
  return m;
}

const varyings = 'varying vec3 v_object; varying vec3 v_object_normal;';
