// SPDX-License-Identifier: GPL-3.0-or-later
// What the browser keeps from visit to visit.

/** Null in browsers that forbid it. */
export function browserStore(): Storage | null {
  try {
    return window.localStorage;
  } catch {
    return null;
  }
}
