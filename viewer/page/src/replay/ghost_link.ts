// SPDX-License-Identifier: GPL-3.0-or-later
// From a recording to the live exercise.
import { el } from '../hud/dom';
import { text } from '../languages/text';
import type { RecordedSession } from './session';

/** The live exercise with this run's tools over it. */
export function ghostLink(kept: boolean, session: RecordedSession): HTMLElement[] {
  const href = `./?ghost=${encodeURIComponent(session.name)}`;
  const link = el('a', { href, target: '_blank', rel: 'noopener' }, text('Practise with these tools as a ghost'));
  return kept ? [el('section', { class: 'panel' }, link)] : [];
}
