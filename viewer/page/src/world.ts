// SPDX-License-Identifier: GPL-3.0-or-later
// Everything drawn of one session: built from a bundle, moved by frames, thrown away when the session changes.
import * as THREE from 'three';
import { Artery } from './artery';
import { Blood } from './blood';
import type { BodyData, Bundle, SkinnedSurface, SurfaceData } from './bundle';
import { creased, smooth_normals } from './geometry';
import type { HudState } from './hud/state';
import { FieldUniforms } from './materials/field';
import { looks, pressed_count, tissue_material, vessel_material } from './materials/tissue';
import { solid_material } from './materials/solid';
import { bake_shading, type Shading, type Tissue } from './occlusion';
import type { RenderFrame } from './lcm';
import { Playback } from './playback';
import { hash_text } from './random';
import { drawn_surfaces, region_dye } from './regions';
import { barycentric, NodeField, shell_triangles } from './skinning';
import { set_skin_attributes, SkinTexture, skinned_depth_material } from './skin_shader';
import { PointGrid } from './spatial';
import { Strands } from './strands';
import { Tool } from './tools';
import { grow_vessels, make_tubes, type VesselStyle } from './vessels';

const vessel_styles: Record<string, VesselStyle> = {
  cortex: { density_m2: 11000, radius_m: [0.00018, 0.00050], length_m: [0.018, 0.050], vein_share: 0.52 },
  insula: { density_m2: 5000, radius_m: [0.0004, 0.0010], length_m: [0.02, 0.045], vein_share: 0.12 },
};

const tissue_kinds = new Set(['cortex', 'pia', 'insula']);

interface Plan {
  surface: SurfaceData;
  skinned: SkinnedSurface | null;
  skin: SkinTexture | null;
  body: BodyData | null;
  tissue: Tissue;
}

interface Moving {
  index: number;
  skin: SkinTexture;
}

export class World {
  readonly root = new THREE.Group();
  readonly tools = new Map<number, Tool>();
  readonly strands: Strands | null;
  readonly field = new FieldUniforms();
  private readonly blood: Blood;
  private readonly arteries: Artery[] = [];
  private readonly dye_now: number[] = [];
  private infrared = false;
  private last_ms = -1;
  private readonly pressed = Array.from({ length: pressed_count }, () => new THREE.Vector4());
  private readonly moving: Moving[] = [];
  private readonly owned: { dispose(): void }[] = [];

  constructor(readonly bundle: Bundle, field_axis: THREE.Vector3, environment: THREE.Texture | null) {
    const plan: Plan[] = [];
    for (const body of bundle.bodies) {
      if (body.surfaces.length === 0) continue;
      const triangles = shell_triangles(body.surfaces);
      const skin = new SkinTexture(new NodeField(body.rest, triangles.length > 0 ? [] : body.surfaces.map((s) => s.skin_nodes), triangles));
      this.moving.push({ index: body.index, skin });
      this.owned.push(skin);
      for (const s of drawn_surfaces(body.surfaces)) plan.push({ surface: s, skinned: s, skin, body, tissue: as_tissue(s) });
    }
    for (const s of bundle.static) {
      if (tissue_kinds.has(s.material)) plan.push({ surface: s, skinned: null, skin: null, body: null, tissue: as_tissue(s) });
      else if (s.material === 'vessel') this.add_artery(s);
      else this.add_solid(s, field_axis);
    }
    const shading = bake_shading(plan.map((p) => p.tissue));
    plan.forEach((p, i) => {
      if (p.surface.material === 'vessel' && p.skinned && p.body && p.skin) this.add_moving_artery(p.skinned, p.body, p.skin, shading[i]!);
      else this.add_tissue(tissue_kinds.has(p.surface.material) ? p.surface : { ...p.surface, material: 'pia' }, p, shading[i]!);
    });
    for (const t of bundle.tools) {
      const tool = new Tool(t, environment, this.field);
      tool.add_to(this.root);
      this.tools.set(t.index, tool);
      this.owned.push(tool);
    }
    this.strands = bundle.strands.count > 0 ? new Strands(bundle.strands.count, bundle.strands.radius_m, this.field) : null;
    if (this.strands) {
      this.root.add(this.strands.mesh);
      this.owned.push(this.strands);
    }
    this.blood = new Blood(this.field, environment);
    this.root.add(this.blood.surface, this.blood.jet.mesh);
    this.owned.push(this.blood);
  }

  /** The infrared camera's picture instead of the eye's. */
  set_infrared(on: boolean): void { this.infrared = on; }
  get is_infrared(): boolean { return this.infrared; }

  /** Simpler shaders and fewer drops for slow machines. */
  set_cheap(cheap: boolean): void {
    this.root.traverse((o) => {
      if (!(o instanceof THREE.Mesh) || !(o.material as THREE.Material).userData.has_cheap) return;
      const m = o.material as THREE.Material & { defines?: Record<string, unknown> };
      const defines = (m.defines ??= {});
      if (('CHEAP' in defines) === cheap) return;
      if (cheap) defines.CHEAP = '';
      else delete defines.CHEAP;
      m.needsUpdate = true;
    });
    this.blood.jet.set_cheap(cheap);
  }

  update(playback: Playback, now_ms: number, state: HudState | null): void {
    const frame = playback.latest;
    if (!frame) return;
    const dt = this.last_ms < 0 ? 0 : Math.min(1, (now_ms - this.last_ms) / 1000);
    this.last_ms = now_ms;
    const t = playback.blend(now_ms);
    for (const m of this.moving) {
      const x = playback.nodes(m.index, t);
      if (x && x.length === m.skin.field.rest.length) m.skin.update(x);
    }
    this.strands?.update(playback.strand_ends(t), frame.strand_integrity, frame.strand_tension_N, now_ms / 1000);
    this.update_pressed(frame);
    this.update_flow(state, frame.sim_time_s, dt);
    for (const [index, tool] of this.tools) {
      const pair = playback.tool(index);
      // On the tray it is not in the picture.
      if (!pair || pair.b.state === 0) { tool.hide(); continue; }
      const { b } = pair;
      // What just came from the tray was elsewhere a frame ago.
      const a = pair.a.state === 0 ? b : pair.a;
      const p = vector(a.p_m).lerp(vector(b.p_m), t);
      const q = quaternion(a.q).slerp(quaternion(b.q), t);
      const device = b.state === 2 || b.hand < 0 || tool.data.clip ? null : vector(a.device_p_m).lerp(vector(b.device_p_m), t);
      tool.set_pose(p, q, a.opening_rad + (b.opening_rad - a.opening_rad) * t, device);
    }
  }

  /** Blood, pulse, dye and the change between the two pictures. */
  private update_flow(state: HudState | null, time_s: number, dt: number): void {
    const f = this.field;
    f.seconds.value = time_s;
    const phase = state?.heart_phase ?? null;
    f.pulse.value = phase === null ? 0.5 : pulse_shape(phase);
    f.infrared.value += ((this.infrared ? 1 : 0) - f.infrared.value) * (1 - Math.exp(-dt * 6));
    const vessels = state?.vessels ?? [];
    const artery = this.arteries[0];
    if (artery) region_dye(artery.regions, vessels).forEach((d, i) => {
      // The engine's dye moves from station to station; the picture follows within a fifth of a second.
      this.dye_now[i] = (this.dye_now[i] ?? 0) + (d - (this.dye_now[i] ?? 0)) * (1 - Math.exp(-dt * 5));
      f.dye.value[i] = this.dye_now[i]!;
    });
    const far = vessels.filter((v) => !['parent', 'sac', 'bleb', 'neck'].includes(v.id)).map((v) => v.dye);
    const mean = far.length > 0 ? far.reduce((a, b) => a + b, 0) / far.length : 0;
    f.dye_far.value += (mean - f.dye_far.value) * (1 - Math.exp(-dt * 0.9));
    this.blood.update(state?.blood ?? null, artery?.bleeding_place() ?? null, dt);
  }

  /** The strongest contacts; they fade in and out, since contacts flicker from step to step. */
  private update_pressed(frame: RenderFrame): void {
    const order = [...frame.contact_N.keys()].filter((i) => frame.contact_N[i]! > 0.005).sort((a, b) => frame.contact_N[b]! - frame.contact_N[a]!).slice(0, pressed_count);
    this.pressed.forEach((p, k) => {
      const i = order[k];
      if (i === undefined) { p.w *= 0.9; return; }
      const force = p.w + 0.15 * (frame.contact_N[i]! - p.w);
      p.set(frame.contact_x_m[3 * i]!, frame.contact_x_m[3 * i + 1]!, frame.contact_x_m[3 * i + 2]!, force);
    });
  }

  dispose(): void {
    this.root.removeFromParent();
    for (const o of this.owned) o.dispose();
  }

  private add(geometry: THREE.BufferGeometry, material: THREE.Material, casts: boolean, skin: SkinTexture | null): THREE.Mesh {
    const mesh = new THREE.Mesh(geometry, material);
    mesh.castShadow = casts;
    mesh.receiveShadow = true;
    if (skin) {
      mesh.customDepthMaterial = skinned_depth_material(skin);
      this.owned.push(mesh.customDepthMaterial);
      mesh.frustumCulled = false;
    }
    this.root.add(mesh);
    this.owned.push(geometry, material);
    return mesh;
  }

  private add_solid(s: SurfaceData, field_axis: THREE.Vector3): void {
    const shape = creased(s.positions, s.indices, s.material === 'bone' ? 0.75 : 1.1);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(shape.positions, 3));
    geometry.setAttribute('normal', new THREE.BufferAttribute(shape.normals, 3));
    this.add(geometry, solid_material(s.material, this.field, field_axis.clone()), true, null);
  }

  private add_artery(s: SurfaceData): void {
    const tissue = as_tissue(s);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(s.positions, 3));
    geometry.setAttribute('normal', new THREE.BufferAttribute(tissue.normals, 3));
    geometry.setIndex(new THREE.BufferAttribute(s.indices, 1));
    geometry.setAttribute('vessel', new THREE.BufferAttribute(new Float32Array((s.positions.length / 3) * 2).map((_, i) => i % 2), 2));
    this.add(geometry, vessel_material(null, this.field), true, null);
  }

  private add_moving_artery(s: SkinnedSurface, body: BodyData, skin: SkinTexture, shading: Shading): void {
    const artery = new Artery(s, body, skin, shading.openness, this.field);
    this.arteries.push(artery);
    this.add(artery.geometry, artery.material, true, skin);
  }

  private add_tissue(s: SurfaceData, plan: Plan, shading: Shading): void {
    const n = s.positions.length / 3;
    const { tissue, skinned, skin, body } = plan;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(s.positions, 3));
    geometry.setAttribute('normal', new THREE.BufferAttribute(tissue.normals, 3));
    geometry.setIndex(new THREE.BufferAttribute(s.indices, 1));
    if (skinned && body) set_skin_attributes(geometry, skinned.skin_nodes, skinned.skin_weights, body.rest);
    const pairs = new Float32Array(n * 2);
    for (let i = 0; i < n; i++) { pairs[i * 2] = shading.openness[i]!; pairs[i * 2 + 1] = shading.convexity[i]!; }
    geometry.setAttribute('shading', new THREE.BufferAttribute(pairs, 2));
    this.add(geometry, tissue_material(looks[s.material] ?? looks.cortex!, skin, this.pressed, this.field), true, skin);
    this.add_vessels(s, tissue, shading, skinned, skin, body?.rest ?? null);
  }

  private add_vessels(s: SurfaceData, tissue: Tissue, shading: Shading, skinned: SkinnedSurface | null, skin: SkinTexture | null, rest: Float32Array | null): void {
    const vessels = grow_vessels(tissue, shading, vessel_styles[s.material] ?? vessel_styles.cortex!, hash_text(s.id));
    const tubes = make_tubes(vessels);
    const n = tubes.kind.length;
    if (n === 0) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(tubes.positions, 3));
    geometry.setAttribute('normal', new THREE.Float32BufferAttribute(tubes.normals, 3));
    geometry.setIndex(tubes.indices);
    const grid = new PointGrid(s.positions, 0.002);
    const pairs = new Float32Array(n * 2);
    const nodes = new Uint32Array(n * 4);
    const weights = new Float32Array(n * 4);
    for (let i = 0; i < n; i++) {
      const f = tubes.foot.slice(i * 3, i * 3 + 3);
      const v = Math.max(0, grid.nearest(f[0]!, f[1]!, f[2]!, 0.004));
      pairs[i * 2] = tubes.kind[i]!;
      pairs[i * 2 + 1] = Math.min(1, shading.openness[v]! * 1.15);
      if (!skinned || !rest) continue;
      // The tube follows the tetrahedron of the nearest surface vertex.
      const w = barycentric(rest, skinned.skin_nodes, v * 4, tubes.positions.slice(i * 3, i * 3 + 3));
      for (let k = 0; k < 4; k++) {
        nodes[i * 4 + k] = skinned.skin_nodes[v * 4 + k]!;
        weights[i * 4 + k] = w ? w[k]! : skinned.skin_weights[v * 4 + k]!;
      }
    }
    geometry.setAttribute('vessel', new THREE.BufferAttribute(pairs, 2));
    if (skinned && rest) set_skin_attributes(geometry, nodes, weights, rest);
    this.add(geometry, vessel_material(skin, this.field), false, skin);
  }
}

/** Rises fast in systole, falls off slowly; 0..1. */
function pulse_shape(phase: number): number {
  const p = phase - Math.floor(phase);
  return p < 0.15 ? Math.sin((p / 0.15) * Math.PI * 0.5) : Math.exp(-(p - 0.15) * 3.2);
}

function as_tissue(s: SurfaceData): Tissue {
  return { positions: s.positions, indices: s.indices, normals: smooth_normals(s.positions, s.indices) };
}

export const vector = (a: ArrayLike<number>) => new THREE.Vector3(a[0], a[1], a[2]);
/** w x y z, as in the messages. */
export const quaternion = (a: ArrayLike<number>) => new THREE.Quaternion(a[1], a[2], a[3], a[0]).normalize();
