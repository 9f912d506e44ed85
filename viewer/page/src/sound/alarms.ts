// SPDX-License-Identifier: GPL-3.0-or-later
// Decides when an alarm sounds. One that happened once sounds once. One that lasts, such as a limit that is passed,
// sounds when it has lasted for a moment, and again after ever longer pauses: it is known by then, and goes on.
import type { Priority } from './table';

/** Shorter than this is no alarm, s. */
const holdS = 1;
/** To the first reminder, s; each following one takes twice as long. */
const remindS: Record<Priority, number> = { high: 10, medium: 20, low: 60 };
/** What happens again and again is heard once in this time, s. */
const sameS = 6;
const rank: Record<Priority, number> = { low: 0, medium: 1, high: 2 };

interface Lasting {
  nextS: number;
  pauseS: number;
}

export class Alarms {
  private readonly lasting = new Map<string, Lasting>();
  private readonly sounded = new Map<Priority, number>();
  private busyUntilS = -Infinity;
  private sounding: Priority = 'low';

  /** Something happened: whether its alarm is heard. */
  event(priority: Priority, nowS: number): boolean {
    const last = this.sounded.get(priority) ?? -Infinity;
    if (nowS - last < sameS) return false;
    if (nowS < this.busyUntilS && rank[priority] <= rank[this.sounding]) return false;
    this.sounded.set(priority, nowS);
    return true;
  }

  /** What lasts now, by name: the priority of what is to be heard, or null. */
  watch(present: ReadonlyMap<string, Priority>, nowS: number): Priority | null {
    for (const id of this.lasting.keys()) if (!present.has(id)) this.lasting.delete(id);
    let due: Priority | null = null;
    for (const [id, priority] of present) {
      let l = this.lasting.get(id);
      if (!l) this.lasting.set(id, (l = { nextS: nowS + holdS, pauseS: remindS[priority] }));
      if (nowS >= l.nextS && (!due || rank[priority] > rank[due])) due = priority;
    }
    if (due && nowS < this.busyUntilS && rank[due] <= rank[this.sounding]) return null;
    // One burst tells of all that is due.
    if (due) for (const l of this.lasting.values()) if (nowS >= l.nextS) this.remind(l, nowS);
    return due;
  }

  /** A burst began that takes so long, s. */
  began(priority: Priority, nowS: number, lengthS: number): void {
    this.sounding = priority;
    this.busyUntilS = nowS + lengthS;
  }

  /** As at the start. */
  reset(): void {
    this.lasting.clear();
    this.sounded.clear();
    this.busyUntilS = -Infinity;
  }

  private remind(l: Lasting, nowS: number): void {
    l.nextS = nowS + l.pauseS;
    l.pauseS *= 2;
  }
}
