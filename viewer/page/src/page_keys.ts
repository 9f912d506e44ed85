// SPDX-License-Identifier: GPL-3.0-or-later
// The keys of the live page that change the view or the sound, or ask for something.
import type { Guiding } from './guiding';
import type { Hands } from './hands';
import type { Hud } from './hud/hud';
import { listenForShortcuts } from './shortcuts';
import type { ViewModes } from './view_modes';

interface Page {
  modes: ViewModes;
  hud: Hud;
  guiding: Guiding;
  hands: Hands;
}

export function listenForPageKeys({ modes, hud, guiding, hands }: Page): void {
  listenForShortcuts({
    u: () => modes.toggleDepth(),
    k: () => modes.nextRuler(),
    l: () => hud.toggleToolList(),
    i: () => modes.setInfrared(!modes.infrared),
    j: () => hud.view.askGlow(),
    o: () => modes.nextStereo(),
    m: () => hud.sound.toggleSound(),
    n: (shift) => guiding.step(hands.active, shift ? -1 : 1),
    '[': () => modes.setAngle(modes.angleDeg - 0.5),
    ']': () => modes.setAngle(modes.angleDeg + 0.5),
  });
}
