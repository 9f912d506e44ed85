// SPDX-License-Identifier: GPL-3.0-or-later
// Who uses the mouse goes on in the field after a click on a control; who uses the keyboard stays on the control.

export function returnFocusToField(root: HTMLElement, field: HTMLElement): void {
  let byPointer = false;
  window.addEventListener('pointerdown', () => (byPointer = true), true);
  window.addEventListener('keydown', () => (byPointer = false), true);
  const back = (e: Event) => {
    if (!byPointer || !(e.target instanceof Element)) return;
    const control = e.target.closest('button, select, input:not([type=text], [type=number])');
    if (!control || control.closest('[role=dialog], [aria-haspopup]') || document.activeElement !== control) return;
    // A list that has just opened needs the focus.
    if (control instanceof HTMLSelectElement && e.type === 'click') return;
    field.focus({ preventScroll: true });
  };
  root.addEventListener('click', back);
  root.addEventListener('change', back);
}

/** The first control that can have the focus, for those who leave the field by key. */
export function firstControl(root: HTMLElement): HTMLElement | null {
  for (const e of root.querySelectorAll<HTMLElement>('button:enabled, select, input, summary'))
    if (e.offsetParent !== null) return e;
  return null;
}
