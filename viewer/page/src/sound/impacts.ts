// SPDX-License-Identifier: GPL-3.0-or-later
// Finds in the frames where an instrument begins to touch something. A frame names both sides of each contact; what is
// heard follows from their materials, and how loud from their speed.
import * as THREE from 'three';
import type { Bundle } from '../bundle_types';
import { toolState } from '../hand_tool';
import type { RenderFrame } from '../lcm';
import { hitOf } from './table';
import { inScene, inToolFrame, type ToolFrame } from './tool_frame';
import type { Hit } from './voices/contact';

/** Weaker contacts are not heard, N. */
const leastN = 0.005;
/** Contacts flicker from step to step: what was let go for less goes on, s. */
const apartS = 0.15;
/** Hits of this speed are heard in full, m/s. */
const fullSpeed = 0.15;
/** Slower ones are not heard at all, m/s. */
const leastSpeed: Record<Hit, number> = { bone: 0.004, metal: 0.004, polymer: 0.004, soft: 0.02 };
/** The engine takes speed away before a contact: the fastest of this long before counts, s. */
const beforeS = 0.08;
/** Frames that came farther apart say nothing about speed, s. */
const gapS = 0.25;

export interface Impact {
  what: Hit;
  /** 0 to 1. */
  strength: number;
  speed: number;
}

type ImpactFrame = Pick<RenderFrame, 'sim_time_s' | 'contact_N' | 'contact_x_m' | 'contact_side'> & {
  tool: readonly ToolFrame[];
};

/** The louder the faster, as the square root: a tenth of the energy is still heard. */
export const strengthOf = (speed: number): number => Math.sqrt(Math.min(1, speed / fullSpeed));

const pairOf = (a: string, b: string): string => (a < b ? `${a} ${b}` : `${b} ${a}`);

interface Side {
  owner: string;
  material: string;
  /** Of the bundle; null: it is no tool. */
  tool: number | null;
}

export class Impacts {
  private readonly sides: readonly Side[];
  private readonly names: ReadonlyMap<number, string>;
  private readonly materials: Bundle['materials'];
  /** By pair, when it touched last, s. */
  private readonly touched = new Map<string, number>();
  private past: { timeS: number; tools: Map<number, ToolFrame> }[] = [];

  constructor({ tools, contactSides, materials }: Pick<Bundle, 'tools' | 'contactSides' | 'materials'>) {
    const index = new Map(tools.map((t) => [t.id, t.index]));
    this.names = new Map(tools.map((t) => [t.index, t.id]));
    this.sides = contactSides.map(({ owner, material }) => ({ owner, material, tool: index.get(owner) ?? null }));
    this.materials = materials;
  }

  /** What began to touch with this frame. */
  read(frame: ImpactFrame): Impact[] {
    const now = frame.sim_time_s;
    const last = this.past[this.past.length - 1];
    if (last && now <= last.timeS) {
      if (now < last.timeS) this.forget();
      return [];
    }
    const found = new Map<string, Impact>();
    const present = new Map(frame.tool.filter((t) => t.state !== toolState.onTray).map((t) => [t.index, t]));
    for (let i = 0; i < frame.contact_N.length; i++)
      if (frame.contact_N[i]! >= leastN) this.contact(frame, i, present, found);
    this.rememberHeld([...present.values()], now);
    this.past = [...this.past, { timeS: now, tools: present }].filter((p) => now - p.timeS < beforeS);
    return [...found.values()].filter((x) => x.speed >= leastSpeed[x.what]);
  }

  /** After a reset. */
  forget(): void {
    this.past = [];
    this.touched.clear();
  }

  /** What a tool holds touches it from the start, and so after it was let go. */
  private rememberHeld(present: readonly ToolFrame[], now: number): void {
    const name = (t: ToolFrame) => this.names.get(t.index) ?? '';
    for (const a of present.filter((t) => t.hand >= 0))
      for (const b of present) if (a !== b && a.hand === b.hand) this.touched.set(pairOf(name(a), name(b)), now);
  }

  private contact(
    frame: ImpactFrame,
    i: number,
    present: ReadonlyMap<number, ToolFrame>,
    found: Map<string, Impact>,
  ): void {
    const [a, b] = [this.sides[frame.contact_side[2 * i]!], this.sides[frame.contact_side[2 * i + 1]!]];
    if (!a || !b) return;
    const [toolA, toolB] = [a, b].map((s) => (s.tool === null ? null : (present.get(s.tool) ?? null)));
    const held = [toolA, toolB].find((t) => t && t.state === toolState.inHand && t.hand >= 0);
    const other = held === toolA ? toolB : toolA;
    // What a hand's tool holds belongs to that hand, and is no other side.
    if (!held || other?.hand === held.hand) return;
    const what = hitOf(a.material, b.material, this.materials);
    if (!what) return;
    const now = frame.sim_time_s;
    const pair = pairOf(a.owner, b.owner);
    const since = now - (this.touched.get(pair) ?? -Infinity);
    this.touched.set(pair, now);
    if (since < apartS && !found.has(pair)) return;
    const point = new THREE.Vector3().fromArray(frame.contact_x_m, 3 * i);
    const speed = Math.max(this.speed(point, held, other ?? null, now), found.get(pair)?.speed ?? 0);
    found.set(pair, { what, speed, strength: strengthOf(speed) });
  }

  /** The fastest that the point of the tool has moved against the other side, a moment before. */
  private speed(point: THREE.Vector3, tool: ToolFrame, other: ToolFrame | null, now: number): number {
    const on = inToolFrame(point, tool);
    const onOther = other && inToolFrame(point, other);
    let fastest = 0;
    let [later, laterS]: [THREE.Vector3, number] = [new THREE.Vector3(), now];
    for (const p of [...this.past].reverse()) {
      const was = p.tools.get(tool.index);
      const otherWas = other ? p.tools.get(other.index) : null;
      if (!was || (other && !otherWas) || now - p.timeS > gapS) break;
      // From the other side's point to the tool's: zero now, since they touch.
      const gap = inScene(on, was).sub(onOther && otherWas ? inScene(onOther, otherWas) : point);
      fastest = Math.max(fastest, gap.distanceTo(later) / (laterS - p.timeS));
      [later, laterS] = [gap, p.timeS];
    }
    return fastest;
  }
}
