// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl+Z and Ctrl+Shift+Z (on Apple's keyboards with Command) anywhere on a page, but where text is typed: there they
// belong to the text.

const typesText = (target: EventTarget | null): boolean =>
  (target instanceof HTMLInputElement && ['text', 'number'].includes(target.type)) ||
  (target instanceof HTMLElement && target.isContentEditable);

/** Returns what ends it. */
export function undoKeys(act: (what: 'undo' | 'redo') => void): () => void {
  const pressed = (e: KeyboardEvent): void => {
    if (!(e.ctrlKey || e.metaKey) || e.key.toLowerCase() !== 'z' || typesText(e.target)) return;
    e.preventDefault();
    act(e.shiftKey ? 'redo' : 'undo');
  };
  window.addEventListener('keydown', pressed);
  return () => window.removeEventListener('keydown', pressed);
}
