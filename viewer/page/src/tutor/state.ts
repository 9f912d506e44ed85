// SPDX-License-Identifier: GPL-3.0-or-later
// What the engine's tutor says (tutor of hud_json), read with care: it is text from outside.

import { finite, isObject, word } from '../json_values';

/** A hint with the value that came near its limit. */
export interface HintView {
  id: string;
  text: string;
  /** Whose tool is meant: 0 left, 1 right; -1: none. */
  hand: number;
  /** Channel or metric, its value and the limit, with units. */
  watched: string;
  value: string;
  limit: string;
  /** Of the way to the limit; 1: at the limit. */
  share: number;
  holds: boolean;
  /** When it was said, simulated; null: it was not. */
  timeS: number | null;
}

export interface TutorView {
  /** The last cue; null: none, or this is a test. */
  cue: HintView | null;
  /** What is near a cue, the worst first. */
  causes: HintView[];
  /** All cues, once the exercise has ended. */
  cues: HintView[];
  /** Whether each hint is also a soft force at the hand, as the trainee chose. */
  softGuide: boolean;
  /** The hand that a soft force draws now: 0 left, 1 right; -1: none. */
  guided: number;
}

const handOf = (v: unknown): number => (v === 'left' ? 0 : v === 'right' ? 1 : -1);

function hint(v: unknown): HintView | null {
  if (!isObject(v) || word(v.text) === '') return null;
  return {
    id: word(v.id),
    text: word(v.text),
    hand: handOf(v.hand),
    watched: word(v.watched),
    value: word(v.value),
    limit: word(v.limit),
    share: finite(v.share) ?? 0,
    holds: v.holds === true,
    timeS: finite(v.time_s),
  };
}

const hints = (v: unknown): HintView[] => (Array.isArray(v) ? v.map(hint).filter((h) => h !== null) : []);

export function parseTutor(v: unknown): TutorView {
  const t = isObject(v) ? v : {};
  return {
    cue: hint(t.cue),
    causes: hints(t.causes),
    cues: hints(t.cues),
    softGuide: t.soft_guide === true,
    guided: handOf(t.guided),
  };
}
