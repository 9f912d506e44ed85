// SPDX-License-Identifier: GPL-3.0-or-later
// A scene that is made for the editor: where it is edited, and when it is there.
import type { SceneCopy, ScenesApi } from './api';

const waitMs = 300;

/** Where a copy is edited. */
export const sceneAddress = (name: string): string => `#scene/${name}`;

/** Waits until it can be edited. */
export async function copied(api: ScenesApi, begun: SceneCopy): Promise<SceneCopy> {
  let copy = begun;
  while (copy.state === 'copying') {
    await new Promise((r) => setTimeout(r, waitMs));
    copy = await api.scene(copy.name);
  }
  if (copy.state === 'failed') throw new Error(copy.error);
  return copy;
}
