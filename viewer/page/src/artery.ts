// SPDX-License-Identifier: GPL-3.0-or-later
// A vessel that deforms: its mesh with regions, and the place on it where a tear would bleed.
import * as THREE from 'three';
import type { BodyData, SkinnedSurface } from './bundle';
import { smooth_normals } from './geometry';
import { artery_material } from './materials/artery';
import { type FieldUniforms, region_capacity } from './materials/field';
import { absorb_region, wall_thinness } from './regions';
import { set_skin_attributes, type SkinTexture } from './skin_shader';
import { skin_offsets, skin_vertex } from './skinning';

const watched_vertices = 24;

export class Artery {
  readonly geometry = new THREE.BufferGeometry();
  readonly material: THREE.MeshPhysicalMaterial;
  readonly regions: string[];
  private readonly offsets: Float32Array;
  private readonly normals: Float32Array;
  private readonly tear: number[] = [];

  constructor(private readonly surface: SkinnedSurface, body: BodyData, private readonly skin: SkinTexture, openness: Float32Array, field: FieldUniforms) {
    const n = surface.positions.length / 3;
    this.regions = surface.regions.slice(0, region_capacity);
    const given = surface.vertex_region ?? new Uint32Array(n);
    const region = absorb_region(given, surface.indices, this.regions.indexOf('ends'));
    const thin = wall_thinness(given, this.regions, surface.indices);
    this.normals = smooth_normals(surface.positions, surface.indices);
    const wall = new Float32Array(n * 2);
    // The vessel lies in the fissure: baked darkness would be that of the closed fissure, so it counts by half.
    for (let i = 0; i < n; i++) { wall[i * 2] = 0.5 + 0.5 * openness[i]!; wall[i * 2 + 1] = thin[i]!; }
    this.geometry.setAttribute('position', new THREE.BufferAttribute(surface.positions, 3));
    this.geometry.setAttribute('normal', new THREE.BufferAttribute(this.normals, 3));
    this.geometry.setAttribute('wall', new THREE.BufferAttribute(wall, 2));
    this.geometry.setAttribute('region', new THREE.BufferAttribute(Float32Array.from(region, (r) => Math.min(r, region_capacity - 1)), 1));
    this.geometry.setIndex(new THREE.BufferAttribute(surface.indices, 1));
    set_skin_attributes(this.geometry, surface.skin_nodes, surface.skin_weights, body.rest);
    this.offsets = skin_offsets(body.rest, surface.positions, surface.skin_nodes, surface.skin_weights);
    this.material = artery_material(skin, field);
    const bleb = [this.regions.indexOf('bleb'), this.regions.indexOf('sac')].find((r) => r >= 0 && given.includes(r));
    if (bleb !== undefined) {
      const all = [...given.keys()].filter((v) => given[v] === bleb);
      for (let i = 0; i < Math.min(watched_vertices, all.length); i++) this.tear.push(all[Math.floor((i * all.length) / watched_vertices) % all.length]!);
    }
  }

  /** Middle of the bleb and the wall's outward normal there, as it stands now. */
  bleeding_place(): { at: THREE.Vector3; out: THREE.Vector3 } | null {
    if (this.tear.length === 0) return null;
    const at = new THREE.Vector3(), out = new THREE.Vector3();
    const x: number[] = [], m: number[] = [];
    for (const v of this.tear) {
      skin_vertex(this.skin.field, this.surface.skin_nodes, this.surface.skin_weights, v, this.normals.subarray(v * 3, v * 3 + 3), x, m, this.offsets);
      at.add(new THREE.Vector3(...x));
      out.add(new THREE.Vector3(...m));
    }
    at.divideScalar(this.tear.length);
    if (out.lengthSq() < 1e-9) out.set(0, 0, 1);
    out.normalize();
    // The mean of a cap lies below its top.
    return { at: at.addScaledVector(out, 0.0003), out };
  }
}
