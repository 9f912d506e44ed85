// SPDX-License-Identifier: GPL-3.0-or-later
// Where a frame's tools are, and which of them a hand holds: its own instrument that is not on the tray. What an
// instrument holds is named with the same hand, but it is nobody's instrument.
import type { Bundle } from './bundle_types';
import type { RenderFrame } from './lcm';

/** `state` of a tool in a frame. */
export const toolState = { onTray: 0, inHand: 1, inField: 2 } as const;

export function toolInHand(frame: RenderFrame, bundle: Bundle, hand: number): RenderFrame['tool'][number] | null {
  const side = hand === 0 ? 'left' : 'right';
  return (
    frame.tool.find(
      (t) =>
        t.hand === hand &&
        t.state !== toolState.onTray &&
        bundle.tools.some((d) => d.index === t.index && d.hand === side),
    ) ?? null
  );
}
