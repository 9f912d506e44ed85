// SPDX-License-Identifier: GPL-3.0-or-later
// A clip tried over the neck: where it lies, and what it leaves (tools/case_builder/clip_trial.h).
import { list, number, object, text } from '../../start/api';
import type { Point, Work } from '../api';

export interface LibraryClip {
  name: string;
  bladeMm: number;
}

export interface Found {
  clip: string;
  liftMm: number;
  slideMm: number;
  turnDeg: number;
  grade: number;
  remnantPct: number;
  /** Of each branch over that before, %. */
  flows: [string, number][];
  faults: number;
  /** What is wrong, in words of the case builder. */
  told: string;
  notes: string[];
  /** Ends of each blade's middle line, and of what is shown of the shaft. */
  blades: [Point, Point][];
  grip: Point;
  shaft: Point;
}

export interface Trial {
  work: Work;
  /** Null: nothing yet. */
  found: Found | null;
  /** It was tried with the present choices. */
  current: boolean;
}

const point = (value: unknown): Point => {
  const [x, y, z] = Array.isArray(value) ? value.map(number) : [];
  return [x ?? 0, y ?? 0, z ?? 0];
};

export const libraryOf = (value: unknown): LibraryClip[] =>
  list(value).map((c) => ({ name: text(c.name), bladeMm: number(c.blade_mm) }));

function foundOf(value: unknown): Found | null {
  const f = object(value);
  if (!Array.isArray(f.blades)) return null;
  return {
    clip: text(f.clip),
    liftMm: number(f.lift_mm),
    slideMm: number(f.slide_mm),
    turnDeg: number(f.turn_deg),
    grade: number(f.grade),
    remnantPct: number(f.remnant_pct),
    flows: Object.entries(object(f.flows_pct)).map(([name, pct]) => [name, number(pct)]),
    faults: number(f.faults),
    told: text(f.told),
    notes: list(f.notes).map((n) => text(n.text)),
    blades: f.blades.map((b) => (Array.isArray(b) ? [point(b[0]), point(b[1])] : [point(null), point(null)])),
    grip: point(f.grip),
    shaft: point(f.shaft),
  };
}

export const trialOf = (work: Work, json: Record<string, unknown>): Trial => ({
  work,
  found: foundOf(json.found),
  current: json.current === true,
});
