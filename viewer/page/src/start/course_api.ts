// SPDX-License-Identifier: GPL-3.0-or-later
// Curricula and somebody's way through one, as the gateway tells them, checked before use.
import { said } from '../languages/said';
import { list, number, numberOrNull, object, text, runOf } from './api';
import type { Api, Run } from './api';
import { conditionOf } from './gate_words';
import type { Condition } from './gate_words';

export interface ListedCurriculum {
  id: string;
  title: string;
  text: string;
  /** What is wrong with its file; '': nothing. */
  problem: string;
}

export interface Curricula {
  /** 'ready', 'loading', 'none' or 'refused'. */
  state: string;
  problem: string;
  curricula: ListedCurriculum[];
}

export const standings = ['locked', 'open', 'passed', 'due', 'lapsed'] as const;
export type Standing = (typeof standings)[number];
export type StartMode = 'practice' | 'test';

/** How an attempt is begun so that it counts. */
export interface Terms {
  scene: string;
  sceneTitle: string;
  mode: StartMode;
  /** Of the complications; null: any. */
  seed: number | null;
}

export interface Gate {
  condition: Condition;
  inARow: number;
  needed: number;
  met: boolean;
}

export interface CourseTask {
  id: string;
  title: string;
  text: string;
  standing: Standing;
  lockedBy: string[];
  gates: Gate[];
  attempts: number;
  /** Those that counted, the newest last. */
  runs: Run[];
  attemptsToLevel: number | null;
  passedMs: number | null;
  dueMs: number | null;
  /** Key of the reason for its standing. */
  why: string;
  terms: Terms;
}

export interface CourseModule {
  id: string;
  title: string;
  text: string;
  standing: Standing;
  lockedBy: string[];
  tasks: CourseTask[];
}

export interface Next {
  kind: string;
  task: string;
  /** Key of the reason. */
  why: string;
  /** Attempts of a warm-up that are still to be made. */
  left: number;
  terms: Terms;
}

export interface Course {
  state: string;
  problem: string;
  /** '': no curriculum is followed. */
  id: string;
  title: string;
  text: string;
  passed: boolean;
  next: Next;
  modules: CourseModule[];
}

const texts = (value: unknown): string[] => (Array.isArray(value) ? value.map(text).filter((t) => t !== '') : []);
const standingOf = (value: unknown): Standing => standings.find((s) => s === value) ?? 'locked';

function termsOf(json: Record<string, unknown>): Terms {
  return {
    scene: text(json.exercise),
    sceneTitle: said(text(json.scene_title)),
    mode: json.start === 'test' ? 'test' : 'practice',
    seed: numberOrNull(json.seed),
  };
}

const taskOf = (t: Record<string, unknown>): CourseTask => ({
  id: text(t.id),
  title: said(text(t.title)),
  text: said(text(t.text)),
  standing: standingOf(t.standing),
  lockedBy: texts(t.locked_by),
  gates: list(t.gates).map((g) => ({
    condition: conditionOf(g.condition),
    inARow: number(g.in_a_row),
    needed: Math.max(1, number(g.needed)),
    met: g.met === true,
  })),
  attempts: number(t.attempts),
  runs: list(t.runs)
    .map(runOf)
    .filter((r) => r !== null),
  attemptsToLevel: numberOrNull(t.attempts_to_level),
  passedMs: numberOrNull(t.passed_ms),
  dueMs: numberOrNull(t.due_ms),
  why: text(t.why),
  terms: termsOf(t),
});

export function curriculaOf(json: unknown): Curricula {
  const c = object(json);
  return {
    state: text(c.state),
    problem: text(c.problem),
    curricula: list(c.curricula)
      .map((one) => ({
        id: text(one.id),
        title: said(text(one.title)),
        text: said(text(one.text)),
        problem: text(one.problem),
      }))
      .filter((one) => one.id !== ''),
  };
}

export function courseOf(json: unknown): Course {
  const c = object(json);
  const next = object(c.next);
  return {
    state: text(c.state),
    problem: text(c.problem),
    id: text(c.id),
    title: said(text(c.title)),
    text: said(text(c.text)),
    passed: c.passed === true,
    next: {
      kind: text(next.kind),
      task: text(next.task),
      why: text(next.why),
      left: number(next.left),
      terms: termsOf(next),
    },
    modules: list(c.modules).map((m) => ({
      id: text(m.id),
      title: said(text(m.title)),
      text: said(text(m.text)),
      standing: standingOf(m.standing),
      lockedBy: texts(m.locked_by),
      tasks: list(m.tasks).map(taskOf),
    })),
  };
}

export const askCurricula = async (api: Api): Promise<Curricula> => curriculaOf(await api.ask('curricula'));
export const askCourse = async (api: Api, person: string): Promise<Course> =>
  courseOf(await api.ask('curriculum', { person }));
export const follow = async (api: Api, person: string, curriculum: string): Promise<void> =>
  void (await api.ask('curriculum', {}, { person, curriculum }));
