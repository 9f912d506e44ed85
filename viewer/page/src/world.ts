// SPDX-License-Identifier: GPL-3.0-or-later
// Everything drawn of one session: built from a bundle, moved by frames, thrown away when the session changes.
import * as THREE from 'three';
import type { Bundle } from './bundle_types';
import type { Sight } from './camera';
import { DrawableSet } from './drawables/drawable_set';
import { glide } from './glide';
import { toolState } from './hand_tool';
import type { RenderFrame } from './lcm';
import { setCheapMaterial } from './materials/cheap';
import { FieldUniforms } from './materials/field';
import { pressedCount } from './materials/tissue';
import type { Playback } from './playback';
import type { Level } from './quality';
import { Scenery } from './scenery';
import type { Channels } from './step_data/channels';
import { TipCues } from './tip_cues';
import { Tool } from './tools';

/** Of a picture, for what fades, s. */
const longestS = 1;
/** Of dents below the tools, 1/s. */
const riseRate = 10;
const fadeRate = 6;

export class World {
  readonly root = new THREE.Group();
  /** What is wrong with the newest frame's drawables, one line each. */
  problems: string[] = [];
  readonly cues = new TipCues();
  private readonly field = new FieldUniforms();
  private readonly tools: Tool[];
  private readonly scenery: Scenery;
  private readonly drawables: DrawableSet;
  private readonly pulseChannel: string;
  private readonly pressed = Array.from({ length: pressedCount }, () => new THREE.Vector4());
  private infrared = false;
  private lastMs = -1;

  constructor(
    readonly bundle: Bundle,
    fieldAxis: THREE.Vector3,
    environment: THREE.Texture | null,
  ) {
    this.scenery = new Scenery(bundle, { field: this.field, pressed: this.pressed, fieldAxis });
    this.tools = bundle.tools.map((t) => new Tool(t, environment, this.field, bundle.materials));
    for (const t of this.tools) t.addTo(this.root);
    this.drawables = new DrawableSet(bundle, this.field, environment);
    this.pulseChannel = bundle.bodies.find((b) => b.pulseChannel !== '')?.pulseChannel ?? '';
    this.root.add(this.scenery.root, this.drawables.root, this.cues.root);
  }

  /** Completes the picture of the tissue, in half a second. */
  shade(): void {
    this.scenery.shade();
  }

  /** All but tissue, walls and small vessels: a first picture can do without them. */
  get later(): THREE.Mesh[] {
    const roots = [...this.scenery.solids, ...this.root.children.filter((c) => c !== this.scenery.root)];
    const meshes: THREE.Mesh[] = [];
    for (const root of roots)
      root.traverse((o) => {
        if (o instanceof THREE.Mesh) meshes.push(o);
      });
    return meshes;
  }

  /** Another picture of the room, in all that mirrors it. */
  setEnvironment(room: THREE.Texture): void {
    this.root.traverse((o) => {
      const material = o instanceof THREE.Mesh ? (o.material as THREE.MeshStandardMaterial) : null;
      if (material?.envMap) material.envMap = room;
    });
  }

  /** The infrared camera's picture instead of the eye's. */
  setInfrared(on: boolean): void {
    this.infrared = on;
  }

  /** Simpler shaders, fewer drops and triangles for slow machines. */
  setLevel({ cheap, coarseM }: Level): void {
    this.root.traverse((o) => {
      if (o instanceof THREE.Mesh) setCheapMaterial(o.material as THREE.Material, cheap);
    });
    this.drawables.setCheap(cheap);
    this.scenery.setCheap(cheap);
    this.setCoarse(coarseM);
  }

  /** Between the drawn surfaces and those with all triangles, m, as an estimate; 0: all triangles. */
  setCoarse(toleranceM: number): void {
    this.scenery.setCoarse(toleranceM);
  }

  /** settled: what fades has done so, and the picture depends on the frame alone. */
  update(playback: Playback, nowMs: number, channels: Channels, sight: Sight, settled = false): void {
    const frame = playback.latest;
    if (!frame) return;
    const pastS = this.lastMs < 0 ? 0 : Math.min(longestS, (nowMs - this.lastMs) / 1000);
    const dt = settled ? Infinity : pastS;
    const seconds = nowMs / 1000;
    this.lastMs = nowMs;
    const t = playback.blend(nowMs);
    this.scenery.update((body) => playback.nodes(body, t));
    this.updatePressed(frame, dt);
    this.updateLight(channels, frame.sim_time_s, dt);
    this.problems = this.drawables.update(playback, t, { dt: Math.min(longestS, dt), seconds });
    for (const tool of this.tools) moveTool(tool, playback, t);
    this.cues.update(frame, this.tools, this.scenery.probes, { dt, seconds }, sight);
  }

  dispose(): void {
    this.root.removeFromParent();
    this.scenery.dispose();
    this.drawables.dispose();
    this.cues.dispose();
    for (const t of this.tools) t.dispose();
  }

  /** Pulse, what shines, and the change between the two pictures. */
  private updateLight(channels: Channels, timeS: number, dt: number): void {
    const f = this.field;
    f.seconds.value = timeS;
    const phase = channels.value(this.pulseChannel);
    f.pulse.value = phase === null ? 0.5 : pulseShape(phase);
    f.infrared.value = glide(f.infrared.value, this.infrared ? 1 : 0, 6 * dt);
    let far = 0;
    for (const wall of this.scenery.walls) {
      wall.update(channels, dt);
      far = Math.max(far, wall.mean(channels) ?? 0);
    }
    f.farGlow.value = glide(f.farGlow.value, far, 0.9 * dt);
  }

  /** The strongest contacts; they fade in and out, since contacts flicker from step to step. */
  private updatePressed(frame: RenderFrame, dt: number): void {
    const order = [...frame.contact_N.keys()]
      .filter((i) => frame.contact_N[i]! > 0.005)
      .sort((a, b) => frame.contact_N[b]! - frame.contact_N[a]!)
      .slice(0, pressedCount);
    this.pressed.forEach((p, k) => {
      const i = order[k];
      if (i === undefined) {
        p.w = glide(p.w, 0, fadeRate * dt);
        return;
      }
      const force = glide(p.w, frame.contact_N[i]!, riseRate * dt);
      p.set(frame.contact_x_m[3 * i]!, frame.contact_x_m[3 * i + 1]!, frame.contact_x_m[3 * i + 2]!, force);
    });
  }
}

function moveTool(tool: Tool, playback: Playback, t: number): void {
  const pair = playback.tool(tool.data.index);
  // On the tray it is not in the picture.
  if (!pair || pair.b.state === toolState.onTray) {
    tool.hide();
    return;
  }
  const { b } = pair;
  // What just came from the tray was elsewhere a frame ago.
  const a = pair.a.state === toolState.onTray ? b : pair.a;
  const inHand = b.state === toolState.inHand && b.hand >= 0;
  tool.setPose({
    p: vector(a.p_m).lerp(vector(b.p_m), t),
    q: quaternion(a.q).slerp(quaternion(b.q), t),
    openingRad: a.opening_rad + (b.opening_rad - a.opening_rad) * t,
    device: inHand ? vector(a.device_p_m).lerp(vector(b.device_p_m), t) : null,
    onArm: b.state === toolState.inHand && b.hand < 0,
  });
}

/** Rises fast in systole, falls off slowly; 0..1. */
function pulseShape(phase: number): number {
  const p = phase - Math.floor(phase);
  return p < 0.15 ? Math.sin((p / 0.15) * Math.PI * 0.5) : Math.exp(-(p - 0.15) * 3.2);
}

export const vector = (a: ArrayLike<number>) => new THREE.Vector3(a[0], a[1], a[2]);
/** w x y z, as in the messages. */
export const quaternion = (a: ArrayLike<number>) => new THREE.Quaternion(a[1], a[2], a[3], a[0]).normalize();
