// SPDX-License-Identifier: GPL-3.0-or-later
// What the instructor draws and points at, in the coordinates of the scene. So each page shows it at the same place of
// the field through its own microscope. Strokes fade by themselves.
import type { Drawing, Point } from './messages';

export const strokeLastsMs = 30_000;
export const pointLastsMs = 1200;
const fadesMs = 2000;
const mostStrokes = 60;
const mostPointsOfStroke = 2000;

export interface Stroke {
  id: number;
  points: Point[];
  changedMs: number;
}

export class Strokes {
  readonly list: Stroke[] = [];
  private pointed: { at: Point; ms: number } | null = null;

  take(m: Drawing, nowMs: number): void {
    if (m.kind === 'clear') this.list.length = 0;
    if (m.kind === 'point') this.pointed = { at: m.at, ms: nowMs };
    if (m.kind !== 'stroke') return;
    let stroke = this.list.find((s) => s.id === m.id);
    if (!stroke) {
      stroke = { id: m.id, points: [], changedMs: nowMs };
      this.list.push(stroke);
      if (this.list.length > mostStrokes) this.list.shift();
    }
    stroke.changedMs = nowMs;
    stroke.points.push(...m.points.slice(0, mostPointsOfStroke - stroke.points.length));
  }

  /** Drops what has faded. Whether there is anything to show. */
  age(nowMs: number): boolean {
    for (let k = this.list.length - 1; k >= 0; k--)
      if (nowMs - this.list[k]!.changedMs > strokeLastsMs) this.list.splice(k, 1);
    if (this.pointed && nowMs - this.pointed.ms > pointLastsMs) this.pointed = null;
    return this.list.length > 0 || this.pointed !== null;
  }

  get point(): Point | null {
    return this.pointed?.at ?? null;
  }
}

/** From 1, as drawn, to 0, gone. */
export const opacity = (s: Stroke, nowMs: number): number =>
  Math.min(1, Math.max(0, (strokeLastsMs - (nowMs - s.changedMs)) / fadesMs));
