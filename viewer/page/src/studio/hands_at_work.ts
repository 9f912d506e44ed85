// SPDX-License-Identifier: GPL-3.0-or-later
// While a hand drags, or a text is being typed, an author works on what was there when it began.

const isTyped = (target: EventTarget | null): boolean =>
  target instanceof HTMLInputElement && ['text', 'number', 'range'].includes(target.type);

/** begin: a press or a text within root; it may be told several times. end: neither is left. Returns what ends it. */
export function handsAtWork(root: HTMLElement, begin: () => void, end: () => void): () => void {
  let [pressed, typing] = [false, false];
  const told = () => (pressed || typing ? begin() : end());
  const press = () => {
    pressed = true;
    told();
  };
  // What a release or a click asks for belongs to the press.
  const release = () =>
    window.setTimeout(() => {
      pressed = false;
      told();
    });
  const moved = (e: PointerEvent) => e.buttons === 0 && pressed && release(); // it was released elsewhere
  const typed = (e: Event) => {
    typing ||= isTyped(e.target);
    told();
  };
  const taken = () => {
    typing = false;
    told();
  };
  root.addEventListener('pointerdown', press, true);
  root.addEventListener('input', typed);
  for (const what of ['change', 'focusout']) root.addEventListener(what, taken);
  window.addEventListener('pointermove', moved);
  for (const what of ['pointerup', 'pointercancel']) window.addEventListener(what, release);
  return () => {
    window.removeEventListener('pointermove', moved);
    for (const what of ['pointerup', 'pointercancel']) window.removeEventListener(what, release);
  };
}
