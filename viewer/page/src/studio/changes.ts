// SPDX-License-Identifier: GPL-3.0-or-later
// A list of an author's changes, "NAME=VALUE" each.

/** The value that was chosen last for a name; null: none. */
export function changedValue(changes: readonly string[], name: string): string | null {
  const begin = `${name}=`;
  return changes.findLast((c) => c.startsWith(begin))?.slice(begin.length) ?? null;
}

/** The changes with that one in place of others of its name; null: without any. */
export function withChanged(changes: readonly string[], name: string, value: string | null): string[] {
  const begin = `${name}=`;
  const others = changes.filter((c) => !c.startsWith(begin));
  return value === null ? others : [...others, begin + value];
}
