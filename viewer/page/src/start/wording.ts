// SPDX-License-Identifier: GPL-3.0-or-later
// What the start page says of runs.
import type { History, Run } from './api';
import { listed } from '../languages/lists';
import { text } from '../languages/text';

export const groupTitles: Readonly<Record<string, string>> = {
  skills: text('First skills'),
  training: text('Exercises'),
  cases: text('Cases'),
};

export function durationText(seconds: number): string {
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')} min`;
}

function goalsText({ state, goals, goalsDone: done }: Run): string {
  if (state === 'done') return text('all goals');
  return state === 'failed'
    ? text('{done} of {goals, plural, one {# goal} other {# goals}}, failed', { done, goals })
    : text('{done} of {goals, plural, one {# goal} other {# goals}}', { done, goals });
}

/** "all goals, 2 faults, 1:05 min". */
export function resultText(run: Run): string {
  const faults =
    run.faults === 0
      ? text('no fault')
      : text('{count, plural, one {# fault} other {# faults}}', { count: run.faults });
  return listed([goalsText(run), faults, durationText(run.durationS)]);
}

/** 'new', 'begun', or 'done': all goals were reached once. */
export function stateOf(history: History | undefined): 'new' | 'begun' | 'done' {
  if (!history) return 'new';
  return history.best?.state === 'done' ? 'done' : 'begun';
}

export const stateText: Readonly<Record<ReturnType<typeof stateOf>, string>> = {
  new: text('not tried yet'),
  begun: text('begun'),
  done: text('✓ done'),
};
