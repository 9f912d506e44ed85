// SPDX-License-Identifier: GPL-3.0-or-later
// Keys that change the view or ask for something, wherever the focus is, as long as nothing is typed there.
import { isTyping, keyOf } from './keyboard';

export function listenForShortcuts(commands: Record<string, (shift: boolean) => void>): void {
  window.addEventListener('keydown', (e) => {
    const key = keyOf(e);
    // Some layouts write brackets with AltGr, which browsers report as Control and Alt.
    const other = (e.ctrlKey || e.metaKey || e.altKey) && key !== '[' && key !== ']';
    if (e.repeat || other || isTyping(e.target)) return;
    commands[key]?.(e.shiftKey);
  });
}
