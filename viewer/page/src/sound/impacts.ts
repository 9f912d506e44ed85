// SPDX-License-Identifier: GPL-3.0-or-later
// Finds in the frames where an instrument begins to touch something hard: bone, or another instrument. A frame says
// where contacts are and how strong, and not between what. So the tool whose surface lies at a contact is its one
// side, and what hard surface lies there too is the other. Contacts with tissue have no other side and are not heard.
import * as THREE from 'three';
import type { Bundle } from '../bundle_types';
import { toolState } from '../hand_tool';
import type { RenderFrame } from '../lcm';
import { inScene, inToolFrame, Solid, type ToolFrame, ToolSolid } from './solids';
import { hardMaterials } from './table';
import type { Partner } from './voices/contact';

/** Weaker contacts are not heard, N. */
const leastN = 0.005;
/** The engine's shapes of tools are rounded, and the drawn ones are not; m. */
const reachM = 0.0005;
/** Contacts flicker from step to step: what was let go for less goes on, s. */
const apartS = 0.15;
/** Hits of this speed are heard in full, m/s, and those below the second one not at all. */
const fullSpeed = 0.15;
const leastSpeed = 0.004;
/** The engine takes speed away before a contact: the fastest of this long before counts, s. */
const beforeS = 0.08;
/** Frames that came farther apart say nothing about speed, s. */
const gapS = 0.25;

export interface Impact {
  partner: Partner;
  /** 0 to 1. */
  strength: number;
  speed: number;
}

type ImpactFrame = Pick<RenderFrame, 'sim_time_s' | 'contact_N' | 'contact_x_m'> & { tool: readonly ToolFrame[] };

/** The louder the faster, as the square root: a tenth of the energy is still heard. */
export const strengthOf = (speed: number): number => Math.sqrt(Math.min(1, speed / fullSpeed));

const pairOf = (a: ToolFrame, b: ToolFrame): string => `${Math.min(a.index, b.index)} ${Math.max(a.index, b.index)}`;

export class Impacts {
  private readonly tools: Map<number, ToolSolid>;
  private readonly hard: Solid[];
  /** By pair, when it touched last, s. */
  private readonly touched = new Map<string, number>();
  private past: { timeS: number; tools: Map<number, ToolFrame> }[] = [];

  constructor(bundle: Pick<Bundle, 'tools' | 'static'>) {
    this.tools = new Map(bundle.tools.map((t) => [t.index, new ToolSolid(t)]));
    this.hard = bundle.static.filter((s) => hardMaterials.has(s.material)).map((s) => new Solid(s));
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
    const present = frame.tool.filter((t) => t.state !== toolState.onTray);
    const held = present.filter((t) => t.state === toolState.inHand && t.hand >= 0);
    const point = new THREE.Vector3();
    for (let i = 0; i < frame.contact_N.length && held.length > 0; i++) {
      if (frame.contact_N[i]! < leastN) continue;
      point.fromArray(frame.contact_x_m, 3 * i);
      for (const tool of held) this.side(point, tool, present, now, found);
    }
    // What a tool holds touches it from the start, and so after it was let go.
    for (const a of held)
      for (const b of present) if (a !== b && a.hand === b.hand) this.touched.set(pairOf(a, b), now);
    this.past = [...this.past, { timeS: now, tools: new Map(present.map((t) => [t.index, t])) }].filter(
      (p) => now - p.timeS < beforeS,
    );
    return [...found.values()].filter((x) => x.speed >= leastSpeed);
  }

  /** After a reset. */
  forget(): void {
    this.past = [];
    this.touched.clear();
  }

  /** What a tool touches at a contact, if its surface is there. */
  private side(
    point: THREE.Vector3,
    tool: ToolFrame,
    present: readonly ToolFrame[],
    now: number,
    found: Map<string, Impact>,
  ): void {
    if (!this.tools.get(tool.index)?.touches(point, tool, reachM)) return;
    // What a hand's tool holds belongs to that hand, and is no other side.
    const other = present.find(
      (t) => t.hand !== tool.hand && this.tools.get(t.index)?.touches(point, t, reachM) === true,
    );
    if (!other && !this.hard.some((s) => s.touches(point, reachM))) return;
    const pair = other ? pairOf(tool, other) : `${tool.index} still`;
    const since = now - (this.touched.get(pair) ?? -Infinity);
    this.touched.set(pair, now);
    if (since < apartS && !found.has(pair)) return;
    const speed = Math.max(this.speed(point, tool, other ?? null, now), found.get(pair)?.speed ?? 0);
    found.set(pair, { partner: other ? 'instrument' : 'bone', speed, strength: strengthOf(speed) });
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
