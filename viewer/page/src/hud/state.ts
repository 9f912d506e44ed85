// SPDX-License-Identifier: GPL-3.0-or-later
// What the engine says of the exercise (hud_json of a frame), read with care: it is text from outside.
import { fixed } from '../languages/numbers';
import { said } from '../languages/said';
import { finite, type Json } from '../json_values';
import { parseTutor, type TutorView } from '../tutor/state';

export interface TimerView {
  id: string;
  text: string;
  elapsedS: number;
  limitS: number;
  running: boolean;
}

export interface MeasureView {
  id: string;
  text: string;
  value: number;
  unit: string;
  /** 1 good, 0 neutral, -1 bad. */
  good: number;
  /** Which values are good, in words; '': not said. */
  limit: string;
}

export interface FaultView {
  id: string;
  text: string;
  count: number;
  /** When it was made, seconds; of the first ones. */
  timesS: number[];
  /** What to do instead; '': not said. */
  advice: string;
}

export interface HudState {
  goals: { id: string; text: string; done: boolean }[];
  faults: FaultView[];
  message: string;
  state: string;
  /** What the session is for: waiting, demonstration, practice, test; '': not said. */
  mode: string;
  /** Path of the report; '': none yet. */
  report: string;
  /** File that the session is recorded into; '': none. */
  recording: string;
  /** Why it is not recorded although it should be; '': all is well. */
  unrecorded: string;
  elapsedS: number | null;
  timers: TimerView[];
  measures: MeasureView[];
  /** Tool in each hand, by id. */
  hands: { hand: string; tool: string }[];
  tutor: TutorView;
}

/** Whether the exercise has ended, well or not. */
export const isOver = ({ state }: Pick<HudState, 'state'>): boolean => state === 'done' || state === 'failed';

const isObject = (v: unknown): v is Json => typeof v === 'object' && v !== null;
export const list = (v: unknown): Json[] => (Array.isArray(v) ? v.filter(isObject) : []);
export const text = (v: unknown): string => (v === null || v === undefined ? '' : String(v));

export function parseHud(json: string): HudState | null {
  let j: unknown;
  try {
    j = JSON.parse(json);
  } catch {
    return null;
  }
  if (!isObject(j)) return null;
  return {
    goals: list(j.goals).map((g) => ({ id: text(g.id), text: said(text(g.text ?? g.id)), done: g.done === true })),
    faults: list(j.faults).map((f) => ({
      id: text(f.id),
      text: said(text(f.text ?? f.id)),
      count: finite(f.count) ?? 0,
      timesS: Array.isArray(f.times_s) ? f.times_s.filter((t) => typeof t === 'number') : [],
      advice: said(text(f.advice)),
    })),
    message: said(text(j.message)),
    state: text(j.state),
    mode: text(j.mode),
    report: text(j.report),
    recording: text(j.recording),
    unrecorded: text(j.unrecorded),
    elapsedS: finite(j.elapsed_s),
    timers: list(j.timers).map((t) => ({
      id: text(t.id),
      text: said(text(t.text ?? t.id)),
      elapsedS: finite(t.elapsed_s) ?? 0,
      limitS: finite(t.limit_s) ?? 0,
      running: t.running === true,
    })),
    measures: list(j.measures).map((m) => ({
      id: text(m.id),
      text: said(text(m.text ?? m.id)),
      value: finite(m.value) ?? NaN,
      unit: text(m.unit),
      good: Math.sign(finite(m.good) ?? 0),
      limit: said(text(m.limit)),
    })),
    hands: list(j.hands).map((h) => ({ hand: text(h.hand), tool: text(h.tool) })),
    tutor: parseTutor(j.tutor),
  };
}

/** m:ss.s, with the reader's decimal sign. */
export function clockText(seconds: number): string {
  // Rounded first, so that 59.97 becomes 1:00.0 and not 0:60.0.
  const tenths = Math.round(Math.max(0, seconds) * 10);
  return `${Math.floor(tenths / 600)}:${fixed((tenths % 600) / 10, 1).padStart(4, '0')}`;
}

/**
 * Width of a force bar, 0..1: square root, so that the tens of millinewtons of good retraction are seen beside the
 * device's 3.3 N.
 */
export function forceBar(newtons: number): number {
  return Math.sqrt(Math.min(1, Math.max(0, newtons) / 3.3));
}

/** Measured retraction of brain stays below about 0.2 N; blunt dissection about as much; half a newton is rough. */
export function forceLevel(newtons: number): 'good' | 'high' | 'too_much' {
  return newtons < 0.2 ? 'good' : newtons < 0.5 ? 'high' : 'too_much';
}
