// SPDX-License-Identifier: GPL-3.0-or-later
// A certificate as the gateway gives it, checked before use.
import { list, number, object, runOf, text } from './api';
import type { Run } from './api';

export interface CertifiedTask {
  module: string;
  title: string;
  gates: string[];
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
    curriculum: text(c.curriculum),
    content: text(c.content),
    beganMs: number(c.began_ms),
    passedMs: number(c.passed_ms),
    version: text(c.version),
    digest: text(c.digest),
    tasks: list(c.tasks).map((t) => ({
      module: text(t.module),
      title: text(t.title),
      gates: (Array.isArray(t.gates) ? t.gates : []).map(text),
      attemptsToLevel: number(t.attempts_to_level),
      passedMs: number(t.passed_ms),
      runs: list(t.runs)
        .map(runOf)
        .filter((r) => r !== null),
    })),
  };
}
