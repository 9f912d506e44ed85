// SPDX-License-Identifier: GPL-3.0-or-later
// Which of a frame's tools a hand holds: its own instrument that is not on the tray. What an instrument holds is
// named with the same hand, but it is nobody's instrument.
import type { Bundle } from './bundle_types';
import type { RenderFrame } from './lcm';

export function toolInHand(frame: RenderFrame, bundle: Bundle, hand: number): RenderFrame['tool'][number] | null {
  const side = hand === 0 ? 'left' : 'right';
  return (
    frame.tool.find(
      (t) => t.hand === hand && t.state !== 0 && bundle.tools.some((d) => d.index === t.index && d.hand === side),
    ) ?? null
  );
}
