// SPDX-License-Identifier: GPL-3.0-or-later
// Puts the guide together: what the active hand is to reach next, its ghost in the field, and what its panel says.
import * as THREE from 'three';
import { Aims } from './aims';
import type { Bundle, ToolData } from './bundle_types';
import { Guide, offsetOf, type Axes } from './guide';
import { toolInHand, toolState } from './hand_tool';
import { toolCommands } from './hud/commands';
import type { GuideView } from './hud/guide_panel';
import type { RenderFrame } from './lcm';
import { StyledPlaces } from './styled_places';
import { TargetGhost } from './target_ghost';
import { listed } from './languages/lists';
import { said } from './languages/said';
import { text } from './languages/text';

/** A tool at its target needs no ghost. */
const ghostFromM = 0.0015;
const ghostFromRad = 0.12;
/** So near to what is left over an edge reaches it by a short sweep. */
const sweepFromM = 0.0012;

export interface GuidingInput {
  frame: RenderFrame | null;
  bundle: Bundle | null;
  /** The hand that is guided; -1: none. */
  hand: number;
  axes: Axes;
}

const sweepAcross = (): string => text('Sweep the edge across it');

type TargetStatus = { at: number; of: number; distance_m: number; angle_rad: number } | null;

export class Guiding {
  readonly root = new THREE.Group();
  view: GuideView | null = null;
  /** How the tool of the guided hand should be turned; null: it has no target. */
  private turn: { hand: number; q: THREE.Quaternion } | null = null;
  private readonly guide = new Guide();
  private readonly ghost = new TargetGhost();
  private readonly aims = new Aims();
  private readonly undone = new StyledPlaces('place');

  constructor() {
    this.root.add(this.ghost.root, this.aims.root);
  }

  begin(bundle: Bundle): void {
    this.guide.begin(bundle);
    this.ghost.begin(bundle);
    this.aims.begin(bundle);
    this.undone.begin(bundle);
    this.view = null;
  }

  restart(): void {
    this.guide.restart();
    this.aims.restart();
  }

  step(hand: number, by: 1 | -1): void {
    if (this.view?.leftOver && by > 0) this.aims.passOver();
    else this.guide.step(hand, by);
  }

  /** How the tool of a hand should be turned for its target; null: there is none. */
  wanted(hand: number): THREE.Quaternion | null {
    return this.turn?.hand === hand ? this.turn.q : null;
  }

  update({ frame, bundle, hand, axes }: GuidingInput): TargetStatus {
    this.view = this.turn = null;
    this.ghost.hide();
    this.aims.show([]);
    const held = frame && bundle && hand >= 0 ? toolInHand(frame, bundle, hand) : null;
    if (!frame || !bundle || !held) return null;
    // The example's poses are of the hand, and the tool stays behind the hand where it presses on something.
    const p = new THREE.Vector3(...held.device_p_m);
    const q = new THREE.Quaternion(held.q[1], held.q[2], held.q[3], held.q[0]);
    const buttons = { button1: held.button1 !== 0, button2: held.button2 !== 0 };
    const tool = bundle.tools.find((t) => t.index === held.index);
    const id = tool?.id ?? '';
    const before = this.guide.target(hand)?.target;
    this.guide.see(this.undone.in(frame));
    if (before?.tool === id && !toChoose(before, frame, bundle)) this.guide.follow(hand, p, q, buttons);
    if (tool?.cuts && this.guide.ended(hand)) {
      const status = this.leadOn(frame, held, p, q, axes);
      if (status) return status;
    }
    const next = this.guide.target(hand);
    if (!next) return null;
    const { target, at, of } = next;
    const { nearRad } = target;
    const nearM = this.guide.nearM(hand);
    const offset = offsetOf(p, q, target, axes);
    const takeUp = target.tool !== id;
    this.view = { at, of, offset, nearM, nearRad, leftOver: 0, todo: '', takeUp, waits: this.guide.waits(hand) };
    if (takeUp) {
      const wanted = bundle.tools.find((t) => t.id === target.tool);
      this.view.todo = text('Take up: {tool} (T)', { tool: said(wanted?.title ?? target.tool) });
    } else {
      this.turn = { hand, q: target.q };
      const choice = toChoose(target, frame, bundle);
      this.view.todo = choice
        ? text('Choose from the list: {tool} (L)', { tool: said(choice.title) })
        : this.guide.stays(hand)
          ? toCount(target, buttons, offset.distanceM < nearM, tool?.cuts ?? false)
          : buttonsToDo(target, buttons);
      if (offset.distanceM > ghostFromM || offset.angleRad > ghostFromRad)
        this.ghost.show(frame, held, target.p, target.q);
    }
    return { at, of, distance_m: offset.distanceM, angle_rad: offset.angleRad };
  }

  /** After the example: to what it has left over, with the wrist as it is. null: nothing is left. */
  private leadOn(
    frame: RenderFrame,
    held: RenderFrame['tool'][number],
    p: THREE.Vector3,
    q: THREE.Quaternion,
    axes: Axes,
  ): TargetStatus {
    const places = this.aims.places(frame);
    const to = this.aims.choose(places, p);
    if (!to) return null;
    this.aims.show(places);
    const offset = offsetOf(p, q, { p: to, q }, axes);
    const todo = offset.distanceM < sweepFromM ? sweepAcross() : '';
    const leftOver = places.length;
    const near = { nearM: sweepFromM, nearRad: Math.PI };
    this.view = { at: 0, of: 0, leftOver, offset, ...near, todo, takeUp: false, waits: false };
    if (offset.distanceM > ghostFromM) this.ghost.show(frame, held, to, q);
    return { at: 0, of: 0, distance_m: offset.distanceM, angle_rad: 0 };
  }
}

/** What the example has taken from a tool's list of others and still lies on the tray here; null: nothing. */
export function toChoose(
  target: { tool: string; command: string; argument: string },
  frame: Pick<RenderFrame, 'tool'>,
  bundle: Bundle,
): ToolData | null {
  const offer = toolCommands(bundle).find((o) => o.holder.id === target.tool && o.command.name === target.command);
  const tool = offer?.tools.find((t) => t.id === target.argument);
  const state = frame.tool.find((t) => t.index === tool?.index)?.state;
  return tool && state === toolState.onTray ? tool : null;
}

interface Buttons {
  button1: boolean;
  button2: boolean;
}

/** What to do with the buttons on the way to a target, and at it. */
export function buttonsToDo(target: Buttons, now: Buttons): string {
  const parts = ([1, 2] as const).flatMap((b) => {
    const [wanted, is] = b === 1 ? [target.button1, now.button1] : [target.button2, now.button2];
    if (wanted === is) return [];
    if (!wanted) return [text('let button {button} go', { button: b })];
    return [b === 1 ? text('hold button 1 (Space)') : text('hold button 2 (B)')];
  });
  return parts.length === 0 ? '' : text('At the target: {what}', { what: listed(parts) });
}

/** What to do where something is still to be done. there: at the target. Buttons are let go when it has counted. */
export function toCount(target: Buttons, now: Buttons, there: boolean, cuts: boolean): string {
  const presses = { button1: target.button1 || now.button1, button2: target.button2 || now.button2 };
  const deed = () => (cuts ? sweepAcross() : text('Stay here until the goal is ticked'));
  return buttonsToDo(presses, now) || (there ? deed() : '');
}
