// SPDX-License-Identifier: GPL-3.0-or-later
// The tools of a recorded run over a field: ?ghost=NAME. The live page loads this only when it is asked for.
import { loadBundle } from '../bundle';
import { RunGhost } from './run_ghost';
import { RecordedSession } from './session';
import { sessionOf } from './source';

/** Throws if there is no such recording, or it cannot be read. */
export async function openGhost(name: string): Promise<RunGhost> {
  const session = await RecordedSession.open(name, await sessionOf(name));
  await session.readTimeline();
  return new RunGhost(session, await loadBundle(session.bundle, name));
}
