// SPDX-License-Identifier: GPL-3.0-or-later
// What an empty instrument could take back from the field: how far each thing is that it once held, and how far it is
// turned from how it would be held. Where an instrument holds a thing is learnt while it holds it.
import * as THREE from 'three';
import type { Bundle, ToolData } from './bundle_types';
import { toolState } from './hand_tool';
import { toolCommands } from './hud/commands';
import type { RenderFrame } from './lcm';
import { fixed } from './languages/numbers';
import { said } from './languages/said';
import { text } from './languages/text';

type FrameTool = RenderFrame['tool'][number];

interface Pose {
  p: THREE.Vector3;
  q: THREE.Quaternion;
}

export interface Within {
  tool: ToolData;
  /** 0 left, 1 right: of the instrument. */
  hand: number;
  /** Where it would be held, scene frame. */
  place: THREE.Vector3;
  distanceM: number;
  angleRad: number;
  /** Whether the instrument takes it from here; null: the instrument does not say how far it reaches. */
  taken: boolean | null;
}

const half = new THREE.Quaternion(0, 0, 1, 0);

const poseOf = (t: FrameTool): Pose => ({
  p: new THREE.Vector3(...t.p_m),
  q: new THREE.Quaternion(t.q[1], t.q[2], t.q[3], t.q[0]),
});

/** b in the frame of a. */
const relative = (a: Pose, b: Pose): Pose => {
  const back = a.q.clone().invert();
  return { p: b.p.clone().sub(a.p).applyQuaternion(back), q: back.clone().multiply(b.q) };
};

const compose = (a: Pose, b: Pose): Pose => ({
  p: b.p.clone().applyQuaternion(a.q).add(a.p),
  q: a.q.clone().multiply(b.q),
});

const property = (tool: ToolData, name: string): number | null =>
  tool.properties.find((p) => p.name === name)?.value ?? null;

export class TakeBack {
  private offers: { holder: ToolData; tools: ToolData[] }[] = [];
  /** By tool's index: the instrument in the frame of what it held. */
  private readonly grips = new Map<number, Pose>();

  begin(bundle: Bundle): void {
    this.offers = toolCommands(bundle);
    this.grips.clear();
  }

  /** The nearest thing of the first instrument that is in a hand and empty; null: there is none. */
  nearest(frame: Pick<RenderFrame, 'tool'>): Within | null {
    for (const { holder, tools } of this.offers) {
      const instrument = frame.tool.find((t) => t.index === holder.index);
      if (!instrument || instrument.state === toolState.onTray) continue;
      const things = frame.tool.filter((t) => tools.some((d) => d.index === t.index));
      const loaded = things.find((t) => t.state === toolState.inHand && t.hand === instrument.hand);
      if (loaded) this.grips.set(loaded.index, relative(poseOf(loaded), poseOf(instrument)));
      else return this.nearestOf(holder, instrument, things);
    }
    return null;
  }

  private nearestOf(holder: ToolData, instrument: FrameTool, things: FrameTool[]): Within | null {
    let best: Within | null = null;
    const now = poseOf(instrument);
    for (const t of things) {
      const grip = this.grips.get(t.index);
      if (t.state !== toolState.inField || !grip) continue;
      const wanted = compose(poseOf(t), grip);
      const distanceM = wanted.p.distanceTo(now.p);
      if (best && best.distanceM <= distanceM) continue;
      // It may be held by its other side.
      const angleRad = Math.min(now.q.angleTo(wanted.q), now.q.angleTo(wanted.q.clone().multiply(half)));
      const reach = property(holder, 'reach');
      const askew = property(holder, 'alignment');
      const taken = reach === null || askew === null ? null : distanceM <= reach && angleRad <= askew;
      const tool = this.offers.flatMap((o) => o.tools).find((d) => d.index === t.index)!;
      best = { tool, hand: instrument.hand, place: wanted.p, distanceM, angleRad, taken };
    }
    return best;
  }
}

/** "Straight clip: 6.2 mm away, turned by 12°; button 2 (B) takes it back". */
export function takeBackText({ tool, distanceM, angleRad, taken }: Within): string {
  const values = {
    tool: said(tool.title),
    distance: `${fixed(1000 * distanceM, 1)} mm`,
    angle: `${Math.round((180 * angleRad) / Math.PI)}°`,
  };
  if (taken === null) return text('{tool}: {distance} away, turned by {angle}', values);
  return taken
    ? text('{tool}: {distance} away, turned by {angle}; button 2 (B) takes it back', values)
    : text('{tool}: {distance} away, turned by {angle}; out of reach', values);
}
