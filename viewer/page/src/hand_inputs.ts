// SPDX-License-Identifier: GPL-3.0-or-later
// All that drives the hands on a flat screen: mouse, pen, fingers, keys and gamepads; and what the other keys do.
import type { Microscope } from './camera';
import { GamepadHands } from './gamepad_hands';
import { HandKeys } from './hand_keys';
import { HandPointers } from './hand_pointers';
import type { Hands, ToolPoses } from './hands';
import { firstControl } from './hud/focus';
import type { Hud } from './hud/hud';
import { text } from './languages/text';

export interface Field {
  canvas: HTMLCanvasElement;
  scope: Microscope;
  hud: Hud;
  hudRoot: HTMLElement;
  toolPose: ToolPoses['toolPose'];
  focusAt(x: number, y: number): void;
  togglePause(): void;
  changed(): void;
}

export function listenForHands(hands: Hands, field: Field): void {
  const { canvas, scope, hud } = field;
  canvas.setAttribute('aria-label', text('operating field'));
  new HandPointers(canvas, scope, hands, (x, y) => field.focusAt(x, y));
  new GamepadHands(
    hands,
    () => navigator.getGamepads?.() ?? [],
    () => document.visibilityState === 'visible' && !hud.session.open,
  );
  new HandKeys(hands, {
    changed: () => field.changed(),
    leaveField: () => firstControl(field.hudRoot)?.focus(),
    commands: {
      '1': () => hands.setActive(0),
      '2': () => hands.setActive(1),
      g: () => hands.release(hands.active),
      x: () => hands.holdHere(),
      y: () => hands.toggleAssist(),
      z: () => hud.undoExchange(hands.active),
      v: () => scope.reset(),
      c: () => {
        const t = field.toolPose(hands.active);
        if (t) scope.focus(t.p);
      },
      p: () => field.togglePause(),
      t: (shift) => hud.nextTool(hands.active, shift ? -1 : 1),
      h: () => hud.toggleHelp(),
      '?': () => hud.toggleHelp(),
    },
  });
}
