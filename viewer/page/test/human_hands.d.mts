// SPDX-License-Identifier: GPL-3.0-or-later
// Of the person, what unit tests use.
export interface Seen {
  target: { at: number; of: number; mm: number; degrees: number };
}

export class Person {
  constructor(page: unknown, seed: number, pace?: number);
  look(): Promise<Seen>;
  reach(view: Seen): Promise<Seen>;
  aim(): number[];
}
