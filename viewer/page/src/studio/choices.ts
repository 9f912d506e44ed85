// SPDX-License-Identifier: GPL-3.0-or-later
// What an author chooses for a case, as the gateway keeps it (viewer/gateway/studio_choices.h).
import { list, number, numberOrNull, object, text } from '../start/api';
import type { Point } from './api';
import { type Retractor, retractorsOf } from './retractors/retractors';
import { type WallPatch, wallPatchesOf } from './wall_paint/patches';

export type Neck = { plane: number[] } | { points: number[] } | null;

/** A line along which something was painted or erased, mm. */
export interface Stroke {
  erase: boolean;
  radius_mm: number;
  points: Point[];
}

export interface Choices {
  /** Of a scan: vessel from here up. */
  threshold: number | null;
  label: number | null;
  seed: Point | null;
  /** Of the scan, only so much around the seed. */
  aroundMm: number | null;
  paint: Stroke[];
  /** A point and the direction of what goes, each. */
  cuts: number[][];
  unit: string;
  mirror: boolean;
  neck: Neck;
  inlet: Point | null;
  rebuildMm: number | null;
  vertices: number;
  /** Changes of regions' walls: "neck.young=7 MPa". */
  walls: string[];
  /** Painted parts of the wall. */
  wallPatches: WallPatch[];
  /** Where the vessel is moved to: a shift in mm, a rotation vector in degrees; null: searched for. */
  pose: number[] | null;
  /** null: those of the approach. */
  retractors: Retractor[] | null;
  rehearse: boolean;
  site: string;
  difficulty: number;
  /** Changes of goals, faults and complications: "3.clip.max_grade=1". */
  rules: string[];
  /** That is tried, and built with; '': proposed. */
  clip: string;
  liftMm: number | null;
  slideMm: number | null;
  turnDeg: number | null;
}

const numbers = (value: unknown): number[] => (Array.isArray(value) ? value.map(number) : []);

export function point(value: unknown): Point {
  const [x = 0, y = 0, z = 0] = numbers(value);
  return [x, y, z];
}

const pointOrNull = (value: unknown): Point | null => (Array.isArray(value) ? point(value) : null);

function neckOf(value: unknown): Neck {
  const neck = object(value);
  if (Array.isArray(neck.plane)) return { plane: numbers(neck.plane) };
  return Array.isArray(neck.points) ? { points: numbers(neck.points) } : null;
}

export function choicesOf(value: unknown): Choices {
  const c = object(value);
  return {
    threshold: numberOrNull(c.threshold),
    label: numberOrNull(c.label),
    seed: pointOrNull(c.seed),
    aroundMm: numberOrNull(c.around_mm),
    paint: list(c.paint).map((s) => ({
      erase: s.erase === true,
      radius_mm: number(s.radius_mm),
      points: Array.isArray(s.points) ? s.points.map(point) : [],
    })),
    cuts: Array.isArray(c.cuts) ? c.cuts.map(numbers) : [],
    unit: text(c.unit),
    mirror: c.mirror === true,
    neck: neckOf(c.neck),
    inlet: pointOrNull(c.inlet),
    rebuildMm: numberOrNull(c.rebuild_mm),
    vertices: number(c.vertices),
    walls: Array.isArray(c.walls) ? c.walls.map(text) : [],
    wallPatches: wallPatchesOf(c.wall_patches),
    pose: Array.isArray(c.pose) ? numbers(c.pose) : null,
    retractors: Array.isArray(c.retractors) ? retractorsOf(c.retractors) : null,
    rehearse: c.rehearse === true,
    site: text(c.site),
    difficulty: number(c.difficulty),
    rules: Array.isArray(c.rules) ? c.rules.map(text) : [],
    clip: text(c.clip),
    liftMm: numberOrNull(c.lift_mm),
    slideMm: numberOrNull(c.slide_mm),
    turnDeg: numberOrNull(c.turn_deg),
  };
}
