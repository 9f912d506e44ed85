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
