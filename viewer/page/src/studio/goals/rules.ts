// SPDX-License-Identifier: GPL-3.0-or-later
// The goals, faults, clocks and complications of a built case's exercises, and an author's changes of them
// (tools/case_builder/rules.h).
import { list, number, object, text } from '../../start/api';
import { changedValue, withChanged } from '../changes';

export interface Rule {
  id: string;
  element: string;
  text: string;
  /** As proposed: parameter to value. */
  values: ReadonlyMap<string, string>;
}

export interface ExerciseRules {
  exercise: number;
  file: string;
  rules: Rule[];
  /** Fibres, and membranes between them. */
  strands: Rule[];
}

const valuesOf = (value: unknown): Map<string, string> =>
  new Map(Object.entries(object(value)).map(([name, v]) => [name, text(v)]));

const rulesOf = (value: unknown): Rule[] =>
  list(value).map((r) => ({
    id: text(r.id),
    element: text(r.element),
    text: text(r.text),
    values: valuesOf(r.values),
  }));

export const exerciseRulesOf = (value: unknown): ExerciseRules[] =>
  list(value).map((e) => ({
    exercise: number(e.exercise),
    file: text(e.file),
    rules: rulesOf(e.rules),
    strands: rulesOf(e.strands),
  }));

/** parameter '': whether the rule is left out. */
const nameOf = (exercise: number, rule: string, parameter: string): string =>
  parameter === '' ? `${exercise}.${rule}` : `${exercise}.${rule}.${parameter}`;

/** What was chosen in place of the proposal; null: nothing. */
export function changeOf(changes: readonly string[], exercise: number, rule: string, parameter = ''): string | null {
  return changedValue(changes, nameOf(exercise, rule, parameter));
}

/** The changes with that one; null: as proposed. */
export function withChange(
  changes: readonly string[],
  exercise: number,
  rule: string,
  parameter: string,
  value: string | null,
): string[] {
  return withChanged(changes, nameOf(exercise, rule, parameter), value);
}
