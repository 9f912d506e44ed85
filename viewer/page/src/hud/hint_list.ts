// SPDX-License-Identifier: GPL-3.0-or-later
// At the end: each hint with its time, and why it came.
import { text } from '../languages/text';
import { whyText } from '../tutor/cue_line';
import type { HintView } from '../tutor/state';
import { el } from './dom';
import { clockText } from './state';

/** Nothing when there was no hint. shown: whether they were seen, which they are not in a test. */
export function hintList(cues: readonly HintView[], shown: boolean): HTMLElement[] {
  if (cues.length === 0) return [];
  const rows = cues.map((c) =>
    el(
      'li',
      { 'data-hint': c.id },
      el('b', {}, c.text),
      el('span', {}, ` ${text('at {time}', { time: clockText(c.timeS ?? 0) })}`),
      el('p', { class: 'advice' }, whyText(c)),
    ),
  );
  return [
    el('h3', {}, shown ? text('Hints, and why they came') : text('Hints that practice would have shown')),
    el('ul', { class: 'summary-list hints' }, ...rows),
  ];
}
