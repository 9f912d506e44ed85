// SPDX-License-Identifier: GPL-3.0-or-later
// Checks the numbers of a drawable against its declaration before anything is drawn with them.
import { DataError, type DrawableData, type DrawableKind } from './declarations';

/** Numbers of one element: a point, a plane, a link. */
const stride: Record<DrawableKind, number> = { points: 4, polylines: 4, patch: 4, plane: 8, label: 4, links: 8 };
/** Of these the first so many place the element and have to be finite. */
const placing: Record<DrawableKind, number> = { points: 3, polylines: 3, patch: 3, plane: 7, label: 3, links: 7 };

/** Numbers of one thing that is drawn whole. */
export const floatsPerElement = (d: DrawableData): number => stride[d.kind] * d.pointsPerLine;

export const elements = (d: DrawableData, data: Float32Array): number => data.length / floatsPerElement(d);

/** Whether an element is drawn at all: of a line that is gone the value is below 0. */
const drawn = (d: DrawableData, data: Float32Array, at: number): boolean =>
  d.kind !== 'polylines' || !(data[at + 3]! < 0);

/** Throws DataError with the drawable's id when the numbers do not fit its declaration or a place is not a number. */
export function checkDrawable(d: DrawableData, data: Float32Array): void {
  const each = floatsPerElement(d);
  if (data.length % each !== 0)
    throw new DataError(`drawable ${d.id}: ${data.length} numbers are not a multiple of ${each}`);
  if (d.kind === 'patch' && data.length !== 0 && data.length !== 4 * d.vertices)
    throw new DataError(
      `drawable ${d.id}: ${data.length} numbers, expected ${4 * d.vertices} of ${d.vertices} vertices`,
    );
  if ((d.kind === 'plane' || d.kind === 'label') && data.length > each)
    throw new DataError(`drawable ${d.id}: ${data.length} numbers, expected ${each}`);
  const step = stride[d.kind];
  for (let at = 0; at < data.length; at += step)
    for (let k = 0; k < placing[d.kind]; k++)
      if (!Number.isFinite(data[at + k]!) && drawn(d, data, at))
        throw new DataError(`drawable ${d.id}: number ${at + k} is ${data[at + k]}`);
}

/**
 * Between two frames: 0 is a, 1 is b. Where the counts differ or a value changes its sign (a line parts), b counts.
 * Quaternions are mixed straight; what draws them makes them unit.
 */
export function mixDrawable(
  d: DrawableData,
  a: Float32Array | null,
  b: Float32Array,
  t: number,
  out: Float32Array,
): void {
  out.set(b);
  if (!a || a.length !== b.length) return;
  const step = stride[d.kind];
  const value = step - 1;
  for (let at = 0; at < b.length; at += step) {
    if (a[at + value]! < 0 !== b[at + value]! < 0) continue;
    for (let k = 0; k < step; k++) {
      const from = a[at + k]!;
      if (Number.isFinite(from)) out[at + k] = from + (b[at + k]! - from) * t;
    }
    if (d.kind === 'links') shortWay(a, b, at + 3, t, out);
  }
}

/** A quaternion and its negative are one rotation: mixed along the shorter way. */
function shortWay(a: Float32Array, b: Float32Array, at: number, t: number, out: Float32Array): void {
  let dot = 0;
  for (let k = 0; k < 4; k++) dot += a[at + k]! * b[at + k]!;
  if (dot >= 0) return;
  for (let k = 0; k < 4; k++) out[at + k] = -a[at + k]! + (b[at + k]! + a[at + k]!) * t;
}
