// SPDX-License-Identifier: GPL-3.0-or-later
// Where the microscope of the running picture stands, as attributes of <view>.
import { number, object } from '../../start/api';

export interface Seen {
  eye: string;
  target: string;
  up: string;
}

const length = (m: readonly number[]): string => `${m.map((x) => Number((1000 * x).toFixed(2))).join(' ')} mm`;
const direction = (v: readonly number[]): string => v.map((x) => Number(x.toFixed(4))).join(' ');

/** A point that was moved with the mouse, m; null: it is no such message. */
export function placedFrom(data: unknown): number[] | null {
  const d = object(data);
  return d.insula === 'placed' && Array.isArray(d.at) && d.at.length === 3 ? d.at.map(number) : null;
}

/** What the picture answers (src/framed.ts): metres in the scene's frame; null: it is no such answer. */
export function viewFrom(data: unknown): Seen | null {
  const d = object(data);
  if (d.insula !== 'view') return null;
  const three = (value: unknown): number[] => (Array.isArray(value) ? value.map(number) : []);
  const [eye, target, up] = [three(d.eye), three(d.target), three(d.up)];
  if ([eye, target, up].some((v) => v.length !== 3)) return null;
  return { eye: length(eye), target: length(target), up: direction(up) };
}
