// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of the first-use tour. Each one watches what really is: the microscope, and tools as the engine sends them.
// It ends when that has changed, whoever did it: a haptic device, a mouse or keys.
import * as THREE from 'three';
import type { Bundle } from '../bundle_types';
import { toolInHand } from '../hand_tool';
import { toolCommands } from '../hud/commands';
import { text } from '../languages/text';
import type { RenderFrame } from '../lcm';

/** What the steps compare, at one time. */
export interface Seen {
  /** Of the microscope from its focus, m, and the direction to it. */
  distanceM: number;
  sight: THREE.Vector3;
  hands: HandSeen[];
  /** How often a clip has come from the tray into an applier, by the events of the engine. */
  loads: number;
}

interface HandSeen {
  /** Id and place of the tool in it; '' and null: none. */
  tool: string;
  p: THREE.Vector3 | null;
  button: boolean;
}

export interface Step {
  id: string;
  title: () => string;
  how: () => string;
  possible(bundle: Bundle): boolean;
  /** start: when the step began. */
  done(start: Seen, now: Seen): boolean;
  /** What was seen at the start can no longer be compared: the step begins anew. */
  outdated?(start: Seen, now: Seen): boolean;
}

const zoomShare = 0.15;
const turnRad = 0.14;
const moveM = 0.006;

/** A hand whose tool was exchanged moves from where the new tool came. */
const moves = (hand: number): Pick<Step, 'done' | 'outdated'> => ({
  done: (start, now) => {
    const [a, b] = [start.hands[hand]!, now.hands[hand]!];
    return a.p !== null && b.p !== null && a.tool === b.tool && a.p.distanceTo(b.p) > moveM;
  },
  outdated: (start, now) => start.hands[hand]!.tool !== now.hands[hand]!.tool,
});
const has = (side: string) => (bundle: Bundle) => bundle.hands.some((h) => h.hand === side && h.tools.length > 0);

export const steps: readonly Step[] = [
  {
    id: 'zoom',
    title: () => text('Zoom the microscope'),
    how: () => text('Turn the wheel over the field, or pinch with two fingers.'),
    possible: () => true,
    done: (start, now) => Math.abs(Math.log(now.distanceM / start.distanceM)) > zoomShare,
  },
  {
    id: 'turn',
    title: () => text('Turn the microscope'),
    how: () => text('Drag with the right mouse button, or with three fingers. V brings the first view back.'),
    possible: () => true,
    done: (start, now) => start.sight.angleTo(now.sight) > turnRad,
  },
  {
    id: 'right_hand',
    title: () => text('Move the right hand'),
    how: () =>
      text('Move your device, or press 2 and drag with the left mouse button. W and S push deeper and draw back.'),
    possible: has('right'),
    ...moves(1),
  },
  {
    id: 'left_hand',
    title: () => text('Move the left hand'),
    how: () => text('Move your device, or press 1 for the left hand and drag. Tab changes between the hands.'),
    possible: has('left'),
    ...moves(0),
  },
  {
    id: 'button',
    title: () => text('Press button 1'),
    how: () =>
      text('Hold the first button of your device, or Space: suction draws, blades cut, an applier opens its clip.'),
    possible: (bundle) => bundle.hands.some((h) => h.tools.length > 0),
    done: (start, now) => now.hands.some((h, k) => h.button && !start.hands[k]!.button),
  },
  {
    id: 'exchange',
    title: () => text('Exchange a tool'),
    how: () => text('Draw the tool out of the field first. Then press T, or click another tool of the hand.'),
    possible: (bundle) => bundle.hands.some((h) => h.tools.length > 1),
    done: (start, now) =>
      now.hands.some((h, k) => h.tool !== '' && start.hands[k]!.tool !== '' && h.tool !== start.hands[k]!.tool),
  },
  {
    id: 'choose',
    title: () => text('Choose a clip from the list'),
    how: () => text('Press L, or click the name of the clip, and choose another one with the arrow keys and Enter.'),
    possible: (bundle) => (toolCommands(bundle)[0]?.tools.length ?? 0) > 1,
    done: (start, now) => now.loads > start.loads,
  },
];

export function see(
  frame: RenderFrame,
  bundle: Bundle,
  scope: { distance: number; axes(): { z: THREE.Vector3 } },
  loads: number,
): Seen {
  const hands = [0, 1].map((hand) => {
    const tool = toolInHand(frame, bundle, hand);
    return {
      tool: bundle.tools.find((t) => t.index === tool?.index)?.id ?? '',
      p: tool ? new THREE.Vector3(tool.p_m[0], tool.p_m[1], tool.p_m[2]) : null,
      button: tool !== null && tool !== undefined && tool.button1 !== 0,
    };
  });
  return { distanceM: scope.distance, sight: scope.axes().z.clone(), hands, loads };
}
