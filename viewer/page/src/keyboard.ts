// SPDX-License-Identifier: GPL-3.0-or-later
// The key that a person reads on the keyboard, whatever its layout. Layouts without Latin letters are read by place.

type KeyLike = Pick<KeyboardEvent, 'key' | 'code'>;

/** 'a'..'z', '0'..'9', '[', ']', '?' or a name in small letters: 'tab', 'arrowleft', 'space', 'shift', 'escape'. */
export function keyOf(e: KeyLike): string {
  if (e.key === ' ') return 'space';
  const key = e.key.toLowerCase();
  if (/^[a-z[\]?]$/.test(key)) return key;
  // A layout whose digits need Shift, or whose letters are not Latin.
  const place = /^(?:Key([A-Z])|Digit([0-9]))$/.exec(e.code);
  if (place && key.length === 1) return (place[1] ?? place[2]!).toLowerCase();
  return key;
}

/** Whether the key would type or choose something where the focus is. */
export function isTyping(target: EventTarget | null): boolean {
  if (target instanceof HTMLInputElement || target instanceof HTMLSelectElement) return true;
  return target instanceof HTMLTextAreaElement;
}

/** Whether the focus is on something that answers to the keys Space, Enter, Tab and the arrows itself. */
export function isControl(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  return target.closest('button, a, summary, input, select, [role=dialog]') !== null;
}
