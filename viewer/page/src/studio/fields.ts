// SPDX-License-Identifier: GPL-3.0-or-later
// Fields of the steps.
import { el } from '../hud/dom';

export const field = (label: string, input: HTMLElement): HTMLElement => el('label', { class: 'field' }, label, input);

export function select(options: readonly (readonly [string, string])[]): HTMLSelectElement {
  return el('select', {}, ...options.map(([value, words]) => el('option', { value }, words)));
}

export function toggle(label: string): { root: HTMLElement; input: HTMLInputElement } {
  const input = el('input', { type: 'checkbox' });
  return { root: el('label', { class: 'toggle' }, input, el('span', {}, label)), input };
}

/** Puts new rows in place of the old ones. The field that had the focus keeps it, by its id. */
export function replaceRows(rows: HTMLElement, all: HTMLElement[]): void {
  const focused = document.activeElement?.id ?? '';
  rows.replaceChildren(...all);
  if (focused !== '' && rows.querySelector(`[id="${focused}"]`)) document.getElementById(focused)!.focus();
}
