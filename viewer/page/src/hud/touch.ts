// SPDX-License-Identifier: GPL-3.0-or-later
// Buttons of a tool for a touch screen.
import { el } from './dom';
import { text } from '../languages/text';

export interface TouchActions {
  button(button: 1 | 2, on: boolean): void;
}

/** Below the field. */
export function makeTouch(actions: TouchActions): HTMLElement {
  const touch = el('div', { class: 'touch' });
  for (const b of [1, 2] as const) {
    const button = el('button', {}, b === 1 ? text('Act') : text('Button 2'));
    button.onpointerdown = () => actions.button(b, true);
    button.onpointerup = button.onpointerleave = button.onpointercancel = () => actions.button(b, false);
    touch.append(button);
  }
  return touch;
}
