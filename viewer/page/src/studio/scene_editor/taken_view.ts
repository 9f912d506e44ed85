// SPDX-License-Identifier: GPL-3.0-or-later
// Writes where the microscope stands into the <view> of the scene, in whichever of its files that is.
import type { SceneCopy, ScenesApi } from './api';
import { applied, type Change, changedAttribute } from './edits';
import { type OutlineElement, outlineOf, withDescendants } from './outline';
import type { Seen } from './seen';

type Writer = (file: string, change: (doc: string) => Change | null) => Promise<void>;

function viewOf(doc: string): OutlineElement | null {
  const root = outlineOf(doc);
  return (root && withDescendants(root).find((e) => e.name === 'view')) ?? null;
}

/** The element's start tag with other values, as one change; null: they are as they were. */
export function changedView(doc: string, seen: Seen): Change | null {
  let now = doc;
  for (const [name, value] of Object.entries(seen)) {
    const view = viewOf(now);
    const change = view && changedAttribute(now, view, name, value);
    if (change) now = applied(now, change);
  }
  const [before, after] = [viewOf(doc), viewOf(now)];
  if (!before || !after || now === doc) return null;
  return { from: before.from, to: before.tagTo, insert: now.slice(after.from, after.tagTo) };
}

/** A new <view> at the end of the root. */
export function addedView(doc: string, { eye, target, up }: Seen): Change | null {
  const root = outlineOf(doc);
  if (!root || root.closeFrom < 0) return null;
  const at = root.closeFrom;
  return { from: at, to: at, insert: `  <view eye="${eye}" target="${target}" up="${up}"/>\n` };
}

/** open: the file in the editor, and its text. */
export async function takenView(
  api: ScenesApi,
  { name, files, scenes }: SceneCopy,
  open: string,
  content: string,
  seen: Seen,
  write: Writer,
): Promise<void> {
  if (viewOf(content)) return write(open, (doc) => changedView(doc, seen));
  for (const file of files) {
    const { text, draft } = await api.file(name, file);
    if (viewOf(draft ?? text)) return write(file, (doc) => changedView(doc, seen));
  }
  await write(scenes.includes(open) ? open : (scenes[0] ?? open), (doc) => addedView(doc, seen));
}
