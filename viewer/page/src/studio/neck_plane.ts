// SPDX-License-Identifier: GPL-3.0-or-later
// The plane of a neck as the case builder will take it (tools/case_builder/wall.cpp).
import { Vector3 } from 'three';
import type { Choices, Facts, Point } from './api';

export interface NeckPlane {
  centre: Vector3;
  normal: Vector3;
  radius: number;
}

const least = 0.3; // mm between the two points
const leastTurn = 0.2; // of the normal's length that is left
const vector = (p: readonly number[], from = 0) => new Vector3(p[from], p[from + 1], p[from + 2]);

/** Through two points, turned from `normal` as little as that asks for. Null: they are no opposite sides of a neck. */
export function planeThrough(a: Vector3, b: Vector3, normal: Vector3): NeckPlane | null {
  const along = b.clone().sub(a);
  const length = along.length();
  if (length < least) return null;
  along.divideScalar(length);
  const turned = normal.clone().addScaledVector(along, -normal.dot(along));
  if (turned.length() < leastTurn) return null;
  return { centre: a.clone().add(b).multiplyScalar(0.5), normal: turned.normalize(), radius: length / 2 };
}

/** With a third point on the dome, no proposal is needed. */
export function planeWithDome(points: readonly Vector3[]): NeckPlane | null {
  const [a, b, dome] = points;
  const middle = a!.clone().add(b!).multiplyScalar(0.5);
  return planeThrough(a!, b!, dome!.clone().sub(middle).normalize());
}

/** That of the choices, else the first proposal. Null: there is none. */
export function chosenPlane(choices: Choices, facts: Facts): NeckPlane | null {
  const first = facts.proposals[0];
  const { neck } = choices;
  if (neck && 'plane' in neck) {
    const near = facts.proposals.find((p) => vector(p.centre).distanceTo(vector(neck.plane)) < least);
    const radius = (near ?? first)?.diameterMm ?? 4;
    return { centre: vector(neck.plane), normal: vector(neck.plane, 3).normalize(), radius: radius / 2 };
  }
  if (!first) return null;
  if (neck) return planeThrough(vector(neck.points), vector(neck.points, 3), vector(first.normal));
  return { centre: vector(first.centre), normal: vector(first.normal), radius: first.diameterMm / 2 };
}

export const asPoint = (v: Vector3): Point => [v.x, v.y, v.z];
