// SPDX-License-Identifier: GPL-3.0-or-later
// What the start page says of runs.
import type { History, Run } from './api';

export const groupTitles: Readonly<Record<string, string>> = {
  skills: 'First skills',
  training: 'Exercises',
  cases: 'Cases',
};

export function durationText(seconds: number): string {
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')} min`;
}

const count = (n: number, what: string): string => `${n} ${what}${n === 1 ? '' : 's'}`;

/** "all goals, 2 faults, 1:05 min". */
export function resultText(run: Run): string {
  const goals =
    run.state === 'done'
      ? 'all goals'
      : `${run.goalsDone} of ${count(run.goals, 'goal')}${run.state === 'failed' ? ', failed' : ''}`;
  return `${goals}, ${run.faults === 0 ? 'no fault' : count(run.faults, 'fault')}, ${durationText(run.durationS)}`;
}

/** 'new', 'begun', or 'done': all goals were reached once. */
export function stateOf(history: History | undefined): 'new' | 'begun' | 'done' {
  if (!history) return 'new';
  return history.best?.state === 'done' ? 'done' : 'begun';
}

export const stateText: Readonly<Record<ReturnType<typeof stateOf>, string>> = {
  new: 'not tried yet',
  begun: 'begun',
  done: '✓ done',
};
