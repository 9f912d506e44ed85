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

/** The row in which a text is being typed that nobody has taken yet. */
function rowOfTyping(rows: HTMLElement): Element | undefined {
  const field = document.activeElement;
  if (!(field instanceof HTMLInputElement) || field.type !== 'text' || field.value === field.defaultValue)
    return undefined;
  return [...rows.children].find((row) => row.contains(field));
}

/** The place of a row among the new ones, by the fields that it holds; -1: it is gone. */
function placeOf(row: Element, all: readonly HTMLElement[]): number {
  const ids = (of: Element) => [...of.querySelectorAll('input[id]')].map((e) => e.id).join();
  return all.findIndex((one) => ids(one) === ids(row));
}

/** What comes in place of rows in which a text is being typed. */
const successors = new WeakMap<Element, HTMLElement>();

/** When the focus leaves it. */
function replacedLater(row: Element, successor: HTMLElement): void {
  const waits = successors.has(row);
  successors.set(row, successor);
  if (waits) return;
  const left = (e: Event) => {
    const to = (e as FocusEvent).relatedTarget;
    if (to instanceof Node && row.contains(to)) return;
    row.removeEventListener('focusout', left);
    row.replaceWith(successors.get(row)!);
    successors.delete(row);
  };
  row.addEventListener('focusout', left);
}

/** Marks in a field what is marked in the one that it replaces. */
function keepMarked(before: Element, after: HTMLElement): void {
  if (!(before instanceof HTMLInputElement) || !(after instanceof HTMLInputElement) || before.type !== 'text') return;
  if (before.value === after.value) after.setSelectionRange(before.selectionStart, before.selectionEnd);
  else after.select();
}

/**
 * Puts new rows in place of the old ones. The field that had the focus keeps it, by its id, and what is
 * marked in it. A row in which a text is
 * being typed stays until that is done: an answer to the change before must not take the text away.
 */
export function replaceRows(rows: HTMLElement, all: HTMLElement[]): void {
  const typing = rowOfTyping(rows);
  const at = typing ? placeOf(typing, all) : -1;
  if (typing && at >= 0) {
    for (const row of [...rows.children]) if (row !== typing) row.remove();
    typing.before(...all.slice(0, at));
    typing.after(...all.slice(at + 1));
    return replacedLater(typing, all[at]!);
  }
  const focused = document.activeElement;
  rows.replaceChildren(...all);
  const heir = focused?.id ? rows.querySelector<HTMLElement>(`[id="${focused.id}"]`) : null;
  if (!focused || !heir) return;
  heir.focus();
  keepMarked(focused, heir);
}
