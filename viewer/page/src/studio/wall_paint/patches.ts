// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of the wall that an author paints, as choices of a case (tools/case_builder/wall_patches.h).
import { list, number, text } from '../../start/api';
import type { Point } from '../api';

export interface WallPatch {
  /** Of the wall, mm. */
  points: Point[];
  radius_mm: number;
  /** With its unit; '': as the wall around it. */
  thickness: string;
  young: string;
}

/** As the gateway allows them. */
export const mostPatches = 20;
export const mostPoints = 200;

/** What a new part is until the author says something else: a plaque. */
export const freshPatch = (): WallPatch => ({ points: [], radius_mm: 1, thickness: '0.5 mm', young: '5 MPa' });

const pointOf = (value: unknown): Point => {
  const [x, y, z] = Array.isArray(value) ? value.map(number) : [];
  return [x ?? 0, y ?? 0, z ?? 0];
};

export const wallPatchesOf = (value: unknown): WallPatch[] =>
  list(value).map((p) => ({
    points: Array.isArray(p.points) ? p.points.map(pointOf) : [],
    radius_mm: number(p.radius_mm),
    thickness: text(p.thickness),
    young: text(p.young),
  }));

export const apart = (a: Point, b: Point): number => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

/** Whether a place is far enough from the points of a stroke that it adds to them. */
export const adds = (stroke: readonly Point[], p: Point, radius: number): boolean =>
  stroke.every((other) => apart(other, p) >= radius / 2);

const rounded = (p: Point): Point => p.map((x) => Math.round(1000 * x) / 1000) as Point;

/** Patches with a stroke at the end of one of them; `at` may be one more than there are. */
export function withStroke(patches: readonly WallPatch[], at: number, stroke: readonly Point[]): WallPatch[] {
  const before = patches[at] ?? freshPatch();
  const fresh = stroke.map(rounded).filter((p) => before.points.every((other) => apart(other, p) > 0));
  const points = [...before.points, ...fresh].slice(0, mostPoints);
  const changed = { ...before, points };
  return at < patches.length ? patches.map((p, k) => (k === at ? changed : p)) : [...patches, changed];
}

/** Without the points of one patch that the eraser has touched. A patch without points goes. */
export function withoutPlaces(patches: readonly WallPatch[], at: number, places: readonly Point[]): WallPatch[] {
  const erased = (p: WallPatch) => ({
    ...p,
    points: p.points.filter((point) => places.every((place) => apart(place, point) > p.radius_mm)),
  });
  return patches.map((p, k) => (k === at ? erased(p) : p)).filter((p) => p.points.length > 0);
}

export const withValue = (patches: readonly WallPatch[], at: number, value: Partial<WallPatch>): WallPatch[] =>
  patches.map((p, k) => (k === at ? { ...p, ...value } : p));
