// SPDX-License-Identifier: GPL-3.0-or-later
// Something that this page has asked for and that will be heard once: on a slow page it may come seconds later, when
// the user has long gone on.

const patienceMs = 30_000;

export class Expected {
  private until = -Infinity;

  expect(nowMs: number): void {
    this.until = nowMs + patienceMs;
  }

  /** True once, if it was expected. */
  met(nowMs: number): boolean {
    const was = nowMs < this.until;
    this.until = -Infinity;
    return was;
  }
}
