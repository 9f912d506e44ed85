// SPDX-License-Identifier: GPL-3.0-or-later
// Brain retractors of a case, as an author chooses them (tools/case_builder/retractors.h). Millimetres, frame of the
// approach.
import { Matrix4, Quaternion, Vector3 } from 'three';
import { list, number, object, text } from '../../start/api';
import type { Point } from '../api';

export interface Retractor {
  lobe: string;
  tip_mm: Point;
  /** Directions: to the handle, and of the side that presses the lobe. */
  shaft: Point;
  flat: Point;
  /** How far it draws the lobe aside. */
  pull_mm: number;
}

/** What the case builder tells of them. */
export interface RetractorFacts {
  proposed: Retractor[];
  lobes: string[];
  centre: Point;
  radiusMm: number;
  most: number;
  mostPullMm: number;
  mostLeanDeg: number;
}

const pointOf = (value: unknown): Point => {
  const [x, y, z] = Array.isArray(value) ? value.map(number) : [];
  return [x ?? 0, y ?? 0, z ?? 0];
};

export const retractorsOf = (value: unknown): Retractor[] =>
  list(value).map((r) => ({
    lobe: text(r.lobe),
    tip_mm: pointOf(r.tip_mm),
    shaft: pointOf(r.shaft),
    flat: pointOf(r.flat),
    pull_mm: number(r.pull_mm),
  }));

export function retractorFactsOf(value: unknown): RetractorFacts | null {
  const f = object(value);
  if (!Array.isArray(f.lobes)) return null;
  return {
    proposed: retractorsOf(f.proposed),
    lobes: f.lobes.map(text),
    centre: pointOf(f.centre),
    radiusMm: number(f.radius_mm),
    most: number(f.most),
    mostPullMm: number(f.most_pull_mm),
    mostLeanDeg: number(f.most_lean_deg),
  };
}

const vector = (p: Point): Vector3 => new Vector3(...p);
const rounded = (v: Vector3, digits: number): Point =>
  v.toArray().map((x) => Math.round(10 ** digits * x) / 10 ** digits + 0) as Point;

/** Its blade has its shaft along z and its flat side along x. */
export function turnOf(r: Retractor): Quaternion {
  const [z, x] = [vector(r.shaft).normalize(), vector(r.flat)];
  x.addScaledVector(z, -x.dot(z)).normalize();
  return new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(x, z.clone().cross(x), z));
}

/** The same retractor at another place. */
export const placedAs = (r: Retractor, tip: Vector3, turn: Quaternion): Retractor => ({
  ...r,
  tip_mm: rounded(tip, 3),
  shaft: rounded(new Vector3(0, 0, 1).applyQuaternion(turn), 4),
  flat: rounded(new Vector3(1, 0, 0).applyQuaternion(turn), 4),
});

const degree = Math.PI / 180;

/** Of the shaft off the line of sight, degrees. */
export const leanOf = (r: Retractor, toSurgeon: Point): number => vector(r.shaft).angleTo(vector(toSurgeon)) / degree;

/** Leaned otherwise, in the plane in which it leans now, about its tip. */
export function withLean(r: Retractor, toSurgeon: Point, degrees: number): Retractor {
  const [shaft, sight] = [vector(r.shaft).normalize(), vector(toSurgeon).normalize()];
  const axis = sight.clone().cross(shaft);
  if (axis.length() < 1e-6) axis.copy(vector(r.flat)).cross(shaft);
  const turn = new Quaternion().setFromAxisAngle(axis.normalize(), degrees * degree - sight.angleTo(shaft));
  return placedAs(r, vector(r.tip_mm), turn.multiply(turnOf(r)));
}

/** How far its tip lies before the neck, towards the surgeon, mm; negative: behind it. */
export const depthOf = (r: Retractor, neck: Vector3, toSurgeon: Point): number =>
  vector(r.tip_mm).sub(neck).dot(vector(toSurgeon).normalize());

/** Pushed in or drawn back along its shaft. */
export function withDepth(r: Retractor, neck: Vector3, toSurgeon: Point, mm: number): Retractor {
  const shaft = vector(r.shaft).normalize();
  const along = (mm - depthOf(r, neck, toSurgeon)) / shaft.dot(vector(toSurgeon).normalize());
  return { ...r, tip_mm: rounded(vector(r.tip_mm).addScaledVector(shaft, along), 3) };
}

/** Where it may not stand; '': it may. */
export type Fault = '' | 'outside' | 'lean';
export function faultOfPlace(r: Retractor, facts: RetractorFacts, toSurgeon: Point): Fault {
  if (vector(r.tip_mm).distanceTo(vector(facts.centre)) > facts.radiusMm) return 'outside';
  return leanOf(r, toSurgeon) > facts.mostLeanDeg ? 'lean' : '';
}

/** A new one: of a lobe that none holds yet, as it is proposed, else beside the last one. */
export function another(all: readonly Retractor[], facts: RetractorFacts): Retractor {
  const free = facts.proposed.find((p) => all.every((r) => r.lobe !== p.lobe));
  if (free) return free;
  const like = facts.proposed.find((p) => p.lobe === all.at(-1)?.lobe) ?? facts.proposed[0]!;
  // A blade is 10 mm wide.
  const beside = vector(like.shaft).cross(vector(like.flat)).setLength(11);
  const [one, other] = [1, -1].map((side) => ({
    ...like,
    tip_mm: rounded(vector(like.tip_mm).addScaledVector(beside, side), 3),
  }));
  const away = (r: Retractor) => vector(r.tip_mm).distanceTo(vector(facts.centre));
  return away(one!) <= away(other!) ? one! : other!;
}

export const withRetractor = (all: readonly Retractor[], k: number, value: Partial<Retractor>): Retractor[] =>
  all.map((r, other) => (other === k ? { ...r, ...value } : r));
