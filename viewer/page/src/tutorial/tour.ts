// SPDX-License-Identifier: GPL-3.0-or-later
// Goes through the steps of the tour, one after the other. A step ends only when it was done. The tour can be left, and
// goes on where it was, also after the browser was closed.
import type { Bundle } from '../bundle_types';
import { type Seen, type Step, steps } from './steps';

const key = 'insula.tour';

type Store = Pick<Storage, 'getItem' | 'setItem'>;

/** What the browser keeps. offered: a first visit has been asked. */
interface Kept {
  offered: boolean;
  done: string[];
}

function read(store: Store | null): Kept {
  try {
    const kept: unknown = JSON.parse(store?.getItem(key) ?? 'null');
    if (typeof kept === 'object' && kept !== null) {
      const { offered, done } = kept as Record<string, unknown>;
      const names = Array.isArray(done) ? done.filter((d) => typeof d === 'string') : [];
      return { offered: offered === true, done: names.filter((d) => steps.some((s) => s.id === d)) };
    }
  } catch {
    // As at a first visit.
  }
  return { offered: false, done: [] };
}

export class Tour {
  running = false;
  private kept: Kept;
  private possible: readonly Step[] = [];
  private start: Seen | null = null;

  constructor(private readonly store: Store | null) {
    this.kept = read(store);
  }

  begin(bundle: Bundle): void {
    this.possible = steps.filter((s) => s.possible(bundle));
    this.start = null;
  }

  /** Nobody has been asked yet in this browser. */
  get fresh(): boolean {
    return !this.kept.offered;
  }

  /** Some steps are done, and some are not. */
  get begun(): boolean {
    return this.kept.done.length > 0 && this.step !== null;
  }

  /** The present step; null: all are done. */
  get step(): Step | null {
    return this.possible.find((s) => !this.kept.done.includes(s.id)) ?? null;
  }

  get at(): number {
    return this.possible.filter((s) => this.kept.done.includes(s.id)).length;
  }

  get of(): number {
    return this.possible.length;
  }

  /** Goes on, or begins again when all is done. */
  enter(): void {
    if (this.step === null) this.keep({ offered: true, done: [] });
    else this.keep({ ...this.kept, offered: true });
    this.running = true;
    this.start = null;
  }

  leave(): void {
    this.keep({ ...this.kept, offered: true });
    this.running = false;
  }

  /** What is now. Returns whether a step has ended by it. */
  see(now: Seen): boolean {
    const { step } = this;
    if (!this.running || !step) return false;
    if (!this.start || step.outdated?.(this.start, now)) this.start = now;
    // A button that was held when the step began must first be let go.
    this.start.hands.forEach((h, k) => (h.button = h.button && now.hands[k]!.button));
    if (!step.done(this.start, now)) return false;
    this.keep({ ...this.kept, done: [...this.kept.done, step.id] });
    this.start = null;
    return true;
  }

  private keep(kept: Kept): void {
    this.kept = kept;
    try {
      this.store?.setItem(key, JSON.stringify(kept));
    } catch {
      // A full or forbidden store: the tour lasts as long as the page.
    }
  }
}
