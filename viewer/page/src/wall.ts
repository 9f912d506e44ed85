// SPDX-License-Identifier: GPL-3.0-or-later
// A deforming surface of the style "wall": its mesh with regions, how thin each is, the value each shows, and how well
// each is filled.
import * as THREE from 'three';
import type { BodyData, SkinnedSurface } from './bundle_types';
import { interleave, smoothNormals } from './geometry';
import { glide } from './glide';
import type { FieldUniforms } from './materials/field';
import { regionCapacity, wallMaterial } from './materials/wall';
import { nearestKnown, wallThinness } from './regions';
import { setSkinAttributes, type SkinTexture } from './skin_shader';
import type { Channels } from './step_data/channels';
import { bendEnds, endShare } from './wall_ends';

/** A channel as a share of its largest value. */
function share(channels: Channels, id: string): number {
  const value = channels.value(id) ?? 0;
  return Math.max(0, Math.min(1, value / (channels.find(id)?.max || 1)));
}

/** Pressures, Pa, at which a wall hangs empty and at which it is round. */
const emptyPa = 300;
const roundPa = 5000;

/** 0 of a wall that hangs empty ... 1 of a round one, by the pressure inside; unknown: round. */
export function fullness(pressurePa: number | null): number {
  if (pressurePa === null || !Number.isFinite(pressurePa)) return 1;
  const t = Math.max(0, Math.min(1, (pressurePa - emptyPa) / (roundPa - emptyPa)));
  return t * t * (3 - 2 * t);
}

export class Wall {
  readonly geometry = new THREE.BufferGeometry();
  readonly material: THREE.MeshPhysicalMaterial;
  /** Channel of each region; null: it has none of its own. */
  private readonly channelOf: (string | null)[];
  private readonly pressureOf: (string | null)[];
  private readonly shown = { value: new Float32Array(regionCapacity) };
  private readonly filling = { value: new Float32Array(regionCapacity).fill(1) };
  /** How much light there is where it goes into the tissue, 0..1 at each vertex. */
  private readonly lit: Float32Array;

  constructor(
    surface: SkinnedSurface,
    body: BodyData,
    skin: SkinTexture,
    field: FieldUniforms,
    /** Where each end of the body bends to. */
    endShifts: [number, number, number][],
  ) {
    const n = surface.positions.length / 3;
    const positions = bendEnds(surface.positions, body.ends, endShifts);
    const regions = surface.regions.slice(0, regionCapacity);
    this.channelOf = regions.map((r) => body.channelOfRegion[r] ?? null);
    const given = surface.vertexRegion ?? new Uint32Array(n);
    const region = nearestKnown(
      given,
      surface.indices,
      this.channelOf.map((c) => c !== null),
    );
    const thin = wallThinness(given, regions, body.regionThicknessM, surface.indices);
    const sunk = (i: number) => Math.max(0, ...body.ends.map((end) => endShare(surface.positions, 3 * i, end)));
    this.lit = Float32Array.from({ length: n }, (_, i) => 1 - 0.85 * sunk(i));
    const wall = interleave(this.lit, thin);
    const normals = smoothNormals(positions, surface.indices);
    const shownRegion = Float32Array.from(region, (r) => Math.min(r, regionCapacity - 1));
    this.geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    this.geometry.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
    this.geometry.setAttribute('wall', new THREE.BufferAttribute(wall, 2));
    this.geometry.setAttribute('region', new THREE.BufferAttribute(shownRegion, 1));
    this.geometry.setIndex(new THREE.BufferAttribute(surface.indices, 1));
    setSkinAttributes(this.geometry, surface.skinNodes, surface.skinWeights, body.rest);
    this.pressureOf = regions.map((r) => body.pressureOfRegion[r] ?? null);
    this.material = wallMaterial(skin, field, this.shown, this.filling);
  }

  /** openness: of each vertex. It lies in a gap that was baked shut: that darkness counts by half. */
  shade(openness: Float32Array): void {
    const wall = this.geometry.getAttribute('wall') as THREE.BufferAttribute;
    for (let i = 0; i < wall.count; i++) wall.setX(i, (0.5 + 0.5 * openness[i]!) * this.lit[i]!);
    wall.needsUpdate = true;
  }

  /** Values move from frame to frame; the picture follows within a fifth of a second. */
  update(channels: Channels, dt: number): void {
    this.channelOf.forEach((id, r) => {
      const before = this.shown.value[r]!;
      this.shown.value[r] = glide(before, id === null ? 0 : share(channels, id), 5 * dt);
    });
    // The colour of blood that stays behind changes more slowly than its pressure.
    this.pressureOf.forEach((id, r) => {
      const before = this.filling.value[r]!;
      const wanted = id === null ? 1 : fullness(channels.value(id));
      this.filling.value[r] = glide(before, wanted, 1.2 * dt);
    });
  }

  /** Mean over the regions that have a channel; null: none has. */
  mean(channels: Channels): number | null {
    const ids = [...new Set(this.channelOf.filter((id) => id !== null))];
    return ids.length === 0 ? null : ids.reduce((sum, id) => sum + share(channels, id), 0) / ids.length;
  }
}
