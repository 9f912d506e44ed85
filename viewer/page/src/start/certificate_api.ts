// SPDX-License-Identifier: GPL-3.0-or-later
// A certificate as the gateway gives it, checked before use.
import { said } from '../languages/said';
import { list, number, object, runOf, text } from './api';
import type { Run } from './api';
import { conditionOf } from './gate_words';
import type { Condition } from './gate_words';

export interface CertifiedTask {
  module: string;
  title: string;
  gates: Condition[];
  attemptsToLevel: number;
  passedMs: number;
  runs: Run[];
}

export interface Certificate {
  person: string;
  curriculum: string;
  /** Hash of the curriculum's text. */
  content: string;
  beganMs: number;
  passedMs: number;
  version: string;
  digest: string;
  tasks: CertifiedTask[];
}

export function certificateOf(json: unknown): Certificate {
  const c = object(json);
  return {
    person: text(c.person),
    curriculum: said(text(c.curriculum)),
    content: text(c.content),
    beganMs: number(c.began_ms),
    passedMs: number(c.passed_ms),
    version: text(c.version),
    digest: text(c.digest),
    tasks: list(c.tasks).map((t) => ({
      module: said(text(t.module)),
      title: said(text(t.title)),
      gates: list(t.gates).map(conditionOf),
      attemptsToLevel: number(t.attempts_to_level),
      passedMs: number(t.passed_ms),
      runs: list(t.runs)
        .map(runOf)
        .filter((r) => r !== null),
    })),
  };
}
