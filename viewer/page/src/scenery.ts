// SPDX-License-Identifier: GPL-3.0-or-later
// The surfaces of bodies and of what stands still, each drawn in the style of its material.
import * as THREE from 'three';
import type { BodyData, Bundle, SkinnedSurface, SurfaceData } from './bundle_types';
import { Detail } from './detail';
import { creased, interleave, smoothNormals } from './geometry';
import { indexedGeometry } from './indexed_geometry';
import { setCheapMaterial } from './materials/cheap';
import type { FieldUniforms } from './materials/field';
import { solidMaterial } from './materials/solid';
import { type Pressed, tissueLook, tissueMaterial, vesselMaterial } from './materials/tissue';
import { bakeShading, type Shading, type Tissue } from './occlusion';
import { hashText } from './random';
import { drawnSurfaces } from './regions';
import { barycentric, NodeField, shellTriangles } from './skinning';
import { setSkinAttributes, SkinTexture, skinnedDepthMaterial } from './skin_shader';
import { PointGrid } from './spatial';
import { type MaterialData, materialOf } from './step_data/declarations';
import { TissueProbe } from './tissue_probe';
import { growVessels, makeTubes, vesselStyleOf } from './surface_vessels';
import { Wall } from './wall';
import { endShift } from './wall_ends';

interface Plan {
  surface: SurfaceData;
  /** The surface's skinning, its texture and body; null: it stands still. */
  moving: { skinned: SkinnedSurface; skin: SkinTexture; body: BodyData } | null;
  material: MaterialData;
  tissue: Tissue;
}

export interface SceneryOptions {
  field: FieldUniforms;
  pressed: Pressed;
  /** Out of the operating field. */
  fieldAxis: THREE.Vector3;
}

/** Gives a surface what was baked for it. */
type Shade = (shading: Shading) => void;

export class Scenery {
  readonly root = new THREE.Group();
  readonly walls: Wall[] = [];
  /** Bone, dura, drapes: what a first picture can do without. */
  readonly solids: THREE.Mesh[] = [];
  /** Of all wet surfaces, for distances from tools. */
  readonly probes: TissueProbe[];
  private readonly skins: { index: number; skin: SkinTexture }[] = [];
  private readonly owned: { dispose(): void }[] = [];
  private readonly casters: THREE.Mesh[] = [];
  private readonly detail = new Detail();
  private cheap = false;
  /** What ends of vessels lead into: tissue that stands still. */
  private readonly bed: Float32Array[];
  /** What is still to be shaded, and how. */
  private unshaded: { tissue: Tissue; shade: Shade }[] = [];

  constructor(
    bundle: Bundle,
    private readonly options: SceneryOptions,
  ) {
    const plans: Plan[] = [];
    for (const body of bundle.bodies) plans.push(...this.planBody(body, bundle));
    for (const surface of bundle.static)
      plans.push({
        surface,
        moving: null,
        material: materialOf(bundle.materials, surface.material),
        tissue: asTissue(surface),
      });
    this.bed = plans.filter((p) => p.material.style === 'tissue' && !p.moving).map((p) => p.surface.positions);
    // Solids cast no baked darkness: only wet surfaces are dark where they face each other.
    const wet = plans.filter((p) => p.material.style === 'tissue' || (p.moving && p.material.style === 'wall'));
    this.probes = wet.map(probeOf);
    for (const p of plans) {
      const shade = this.addPlan(p);
      if (shade) this.unshaded.push({ tissue: p.tissue, shade });
    }
  }

  /** Darkens folds, and lets small vessels grow. It takes half a second; without it the field is plain. */
  shade(): void {
    const shading = bakeShading(this.unshaded.map((u) => u.tissue));
    this.unshaded.forEach(({ shade }, k) => shade(shading[k]!));
    this.unshaded = [];
  }

  /** Node positions of each body, or null where there are none. */
  update(nodes: (body: number) => Float32Array | null): void {
    for (const { index, skin } of this.skins) {
      const x = nodes(index);
      if (x && x.length === skin.field.rest.length) skin.update(x);
    }
  }

  /** On slow machines only tools cast shadows: those tell where a tip is. */
  setCheap(cheap: boolean): void {
    this.cheap = cheap;
    for (const mesh of this.casters) mesh.castShadow = !cheap;
  }

  setCoarse(toleranceM: number): void {
    this.detail.setCoarse(toleranceM);
  }

  dispose(): void {
    this.root.removeFromParent();
    for (const o of this.owned) o.dispose();
  }

  private planBody(body: BodyData, bundle: Bundle): Plan[] {
    if (body.surfaces.length === 0) return [];
    const triangles = shellTriangles(body.surfaces);
    const quads = triangles.length > 0 ? [] : body.surfaces.map((s) => s.skinNodes);
    const skin = new SkinTexture(new NodeField(body.rest, quads, triangles));
    this.skins.push({ index: body.index, skin });
    this.owned.push(skin);
    return drawnSurfaces(body.surfaces).map((s) => ({
      surface: s,
      moving: { skinned: s, skin, body },
      material: materialOf(bundle.materials, s.material),
      tissue: asTissue(s),
    }));
  }

  /** null: it needs no shading. */
  private addPlan(p: Plan): Shade | null {
    const { style } = p.material;
    if (style === 'tissue') return this.addTissue(p);
    if (style === 'wall' && p.moving) return this.addMovingWall(p);
    if (style === 'wall') this.addStillWall(p);
    else if (p.moving) this.addMovingSolid(p);
    else this.addSolid(p);
    return null;
  }

  private add(
    geometry: THREE.BufferGeometry,
    material: THREE.Material,
    casts: boolean,
    skin: SkinTexture | null,
  ): THREE.Mesh {
    const mesh = new THREE.Mesh(geometry, material);
    setCheapMaterial(material, this.cheap);
    mesh.castShadow = casts && !this.cheap;
    if (casts) this.casters.push(mesh);
    mesh.receiveShadow = true;
    if (skin) {
      mesh.customDepthMaterial = skinnedDepthMaterial(skin);
      this.owned.push(mesh.customDepthMaterial);
      mesh.frustumCulled = false;
    }
    this.root.add(mesh);
    this.owned.push(geometry, material);
    this.detail.add(geometry);
    return mesh;
  }

  private solid(p: Plan): THREE.MeshPhysicalMaterial {
    const { field, fieldAxis } = this.options;
    const { rgba, roughness, metalness } = p.material;
    const skin = p.moving?.skin ?? null;
    return solidMaterial(p.surface.material, { field, fieldAxis: fieldAxis.clone(), rgba, roughness, metalness, skin });
  }

  private addSolid(p: Plan): void {
    const s = p.surface;
    const geometry = indexedGeometry(creased(s.positions, s.indices, s.material === 'bone' ? 0.75 : 1.1));
    this.solids.push(this.add(geometry, this.solid(p), true, null));
  }

  private addMovingSolid(p: Plan): void {
    const geometry = smoothGeometry(p);
    this.solids.push(this.add(geometry, this.solid(p), true, p.moving!.skin));
  }

  private addStillWall(p: Plan): void {
    const geometry = smoothGeometry(p);
    const n = p.surface.positions.length / 3;
    const plain = new Float32Array(n * 3).map((_, i) => (i % 3 === 0 ? 0 : 1));
    geometry.setAttribute('vessel', new THREE.BufferAttribute(plain, 3));
    this.add(geometry, vesselMaterial(null, this.options.field), true, null);
  }

  private addMovingWall(p: Plan): Shade {
    const { skinned, body, skin } = p.moving!;
    const down = this.options.fieldAxis.clone().negate().toArray();
    const shifts = body.ends.map((end) => endShift(end, this.bed, down));
    const wall = new Wall(skinned, body, skin, this.options.field, shifts);
    this.walls.push(wall);
    this.add(wall.geometry, wall.material, true, skin);
    return ({ openness }) => wall.shade(openness);
  }

  private addTissue(p: Plan): Shade {
    const geometry = smoothGeometry(p);
    const n = p.surface.positions.length / 3;
    geometry.setAttribute(
      'shading',
      new THREE.BufferAttribute(interleave(new Float32Array(n).fill(1), new Float32Array(n)), 2),
    );
    const { pressed, field } = this.options;
    const skin = p.moving?.skin ?? null;
    this.add(geometry, tissueMaterial(tissueLook(p.surface.material, p.material), skin, pressed, field), true, skin);
    return (shading) => {
      geometry.setAttribute('shading', new THREE.BufferAttribute(interleave(shading.openness, shading.convexity), 2));
      this.addVessels(p, shading);
    };
  }

  /** Small vessels on tissue; each follows the tetrahedron of the nearest surface vertex. */
  private addVessels(p: Plan, shading: Shading): void {
    const s = p.surface;
    const tubes = makeTubes(growVessels(p.tissue, shading, vesselStyleOf(s.material), hashText(s.id)));
    const n = tubes.kind.length;
    if (n === 0) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(tubes.positions, 3));
    geometry.setAttribute('normal', new THREE.Float32BufferAttribute(tubes.normals, 3));
    geometry.setIndex(tubes.indices);
    const grid = new PointGrid(s.positions, 0.002);
    const near = Array.from({ length: n }, (_, i) => {
      const f = tubes.foot.slice(i * 3, i * 3 + 3);
      return Math.max(0, grid.nearest(f[0]!, f[1]!, f[2]!, 0.004));
    });
    const lit = Float32Array.from(near, (v) => Math.min(1, shading.openness[v]! * 1.15));
    const vessel = new Float32Array(3 * n);
    for (let i = 0; i < n; i++) vessel.set([tubes.kind[i]!, lit[i]!, tubes.calibre[i]!], 3 * i);
    geometry.setAttribute('vessel', new THREE.BufferAttribute(vessel, 3));
    if (p.moving) skinTubes(geometry, tubes.positions, near, p.moving.skinned, p.moving.body.rest);
    const skin = p.moving?.skin ?? null;
    this.add(geometry, vesselMaterial(skin, this.options.field), false, skin);
  }
}

function skinTubes(
  geometry: THREE.BufferGeometry,
  positions: number[],
  near: number[],
  skinned: SkinnedSurface,
  rest: Float32Array,
): void {
  const nodes = new Uint32Array(near.length * 4);
  const weights = new Float32Array(near.length * 4);
  near.forEach((v, i) => {
    const w = barycentric(rest, skinned.skinNodes, v * 4, positions.slice(i * 3, i * 3 + 3));
    for (let k = 0; k < 4; k++) {
      nodes[i * 4 + k] = skinned.skinNodes[v * 4 + k]!;
      weights[i * 4 + k] = w ? w[k]! : skinned.skinWeights[v * 4 + k]!;
    }
  });
  setSkinAttributes(geometry, nodes, weights, rest);
}

function smoothGeometry(p: Plan): THREE.BufferGeometry {
  const geometry = indexedGeometry(p.tissue);
  if (p.moving) {
    const { skinned, body } = p.moving;
    setSkinAttributes(geometry, skinned.skinNodes, skinned.skinWeights, body.rest);
  }
  return geometry;
}

function probeOf(p: Plan): TissueProbe {
  const moving = p.moving && { surface: p.moving.skinned, field: p.moving.skin.field };
  return new TissueProbe(p.surface.positions, p.tissue.normals, moving);
}

function asTissue(s: SurfaceData): Tissue {
  return { positions: s.positions, indices: s.indices, normals: smoothNormals(s.positions, s.indices) };
}
