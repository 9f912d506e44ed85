// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of a drawable by its material: colour, gloss, how clear it is; styles differ in their wetness.
import * as THREE from 'three';
import { injectVeil } from '../materials/field';
import { solidMaterial, solidNames } from '../materials/solid';
import type { DrawableContext } from './drawn';

interface Wetness {
  clearcoat: number;
  clearcoatRoughness: number;
}

const wet: Record<string, Wetness> = {
  tissue: { clearcoat: 1, clearcoatRoughness: 0.2 },
  wall: { clearcoat: 1, clearcoatRoughness: 0.12 },
  fibre: { clearcoat: 0.8, clearcoatRoughness: 0.2 },
  sheet: { clearcoat: 1, clearcoatRoughness: 0.14 },
  fluid: { clearcoat: 0.8, clearcoatRoughness: 0.1 },
  glass: { clearcoat: 1, clearcoatRoughness: 0.03 },
};

/** What clear materials let through; glass always does. */
function opacity(style: string, rgba: readonly number[], translucency: number): number {
  return rgba[3]! * (style === 'glass' ? 0.35 : 1 - 0.6 * translucency);
}

/** `rgba`: of a single part instead of the material's. */
export function lookOf(c: DrawableContext, rgba: readonly number[] | null = null): THREE.MeshPhysicalMaterial {
  const { material, declared, field } = c;
  const colour = rgba ?? material.rgba;
  // Known solids have a texture of their own.
  if (material.style === 'solid' && solidNames.includes(declared.material))
    return solidMaterial(declared.material, { field });
  const alpha = opacity(material.style, colour, material.translucency);
  const m = new THREE.MeshPhysicalMaterial({
    roughness: material.roughness,
    metalness: material.metalness,
    ...(wet[material.style] ?? {}),
    opacity: alpha,
    transparent: alpha < 1,
    side: THREE.DoubleSide,
  });
  m.color.setRGB(colour[0]!, colour[1]!, colour[2]!, THREE.SRGBColorSpace);
  m.envMap = material.metalness > 0.5 ? c.environment : null;
  m.onBeforeCompile = (shader) => injectVeil(shader, field);
  m.customProgramCacheKey = () => 'drawable';
  return m;
}

/** Places a mesh that moves as it is told: always drawn, with shadows. */
export function moving<T extends THREE.Mesh>(mesh: T): T {
  mesh.frustumCulled = false;
  mesh.castShadow = true;
  mesh.receiveShadow = true;
  return mesh;
}
