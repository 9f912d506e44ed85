// SPDX-License-Identifier: GPL-3.0-or-later
// What shows the depth of the tools in the hands on a flat screen: plumb lines, the ruler, and marks where they press.
import * as THREE from 'three';
import type { Sight } from './camera';
import { ContactMarks, contactsOfTools } from './contact_marks';
import { DepthCue } from './depth_cue';
import { DepthRuler, type RulerMode } from './depth_ruler';
import type { Moment } from './drawables/drawn';
import { toolState } from './hand_tool';
import type { DepthView } from './hud/hand_panel';
import type { RenderFrame } from './lcm';
import { ReachMark } from './reach_mark';
import type { Within } from './take_back';
import type { TissueProbe } from './tissue_probe';
import type { Tool } from './tools';

/** What of it is shown; hand: whose ruler. */
export interface CueChoice {
  plumb: boolean;
  ruler: RulerMode;
  hand: number;
  /** What an instrument could take back; null: nothing. */
  within: Within | null;
}

export class TipCues {
  readonly root = new THREE.Group();
  choice: CueChoice = { plumb: true, ruler: 'off', hand: 1, within: null };
  private readonly cues = [new DepthCue(), new DepthCue()];
  private readonly ruler = new DepthRuler();
  private readonly marks = new ContactMarks();
  private readonly reach = new ReachMark();

  constructor() {
    this.root.add(...this.cues.map((c) => c.root), this.ruler.root, this.marks.root, this.reach.root);
  }

  /**
   * tip_mm: of the tip of each hand's tool from the tissue; ruler_mm: from the tip to the tissue along the ruler;
   * apart_mm: between both tips. null: not shown, or too far.
   */
  get told(): DepthView {
    return {
      tip_mm: this.cues.map((c) => inMm(c.distanceM)),
      ruler_mm: inMm(this.ruler.lengthM),
      apart_mm: inMm(this.ruler.apartM),
    };
  }

  update(
    frame: RenderFrame,
    tools: readonly Tool[],
    probes: readonly TissueProbe[],
    { dt, seconds }: Moment,
    sight: Sight,
  ): void {
    const { plumb, ruler, hand, within } = this.choice;
    this.reach.update(within, sight);
    const leading = [0, 1].map((h) => leadingTool(frame, tools, h));
    const tips = leading.map((t) => t?.tips() ?? []);
    const right = sight.axes.x.clone().multiplyScalar(sight.percentM);
    this.cues.forEach((cue, h) => cue.update(plumb ? tips[h]! : [], probes, seconds, right));
    const shafts = leading.map((t) => (t ? new THREE.Vector3(0, 0, 1).applyQuaternion(t.group.quaternion) : null));
    this.ruler.update({ mode: ruler, tips, hand, shaft: shafts[hand] ?? null, ...sight, probes, seconds });
    const axes = leading.flatMap((t, h) => (t ? [{ tip: t.group.position, shaft: shafts[h]! }] : []));
    this.marks.update(plumb ? contactsOfTools(frame, axes) : [], sight.axes.z, dt);
  }

  dispose(): void {
    this.root.removeFromParent();
    for (const c of this.cues) c.dispose();
    this.ruler.dispose();
    this.marks.dispose();
    this.reach.dispose();
  }
}

/** The hand's tool, or what that tool holds, which reaches farther. */
function leadingTool(frame: RenderFrame, tools: readonly Tool[], hand: number): Tool | null {
  const inHand = frame.tool.filter((t) => t.hand === hand && t.state === toolState.inHand);
  const found = inHand.map((t) => tools.find((d) => d.data.index === t.index)).filter((t) => t !== undefined);
  return found.find((t) => t.data.hand === 'none') ?? found[0] ?? null;
}

const inMm = (m: number | null): number | null => (m === null ? null : 1000 * m);
