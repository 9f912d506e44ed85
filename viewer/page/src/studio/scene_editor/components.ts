// SPDX-License-Identifier: GPL-3.0-or-later
// Components that a new scene begins with.
import type { Declarations, ElementKind } from './declarations';
import { applied, withChild } from './edits';
import { outlineOf } from './outline';
import { startAttributes } from './start_values';

/** A scene's text with children of these kinds, one after the other. */
export function withComponents(doc: string, kinds: readonly ElementKind[], all: Declarations): string {
  return kinds.reduce((now, kind) => {
    const top = outlineOf(now);
    return top ? applied(now, withChild(now, top, kind, startAttributes(all, kind, top))) : now;
  }, doc);
}
