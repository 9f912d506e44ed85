// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a stream has fallen silent. What comes waits while a picture is drawn: where one takes a second, a second without news
// says nothing.
export function silent(now_ms: number, heard_ms: number, limit_ms: number, picture_ms: number): boolean {
  return now_ms - heard_ms > Math.max(limit_ms, 3 * picture_ms);
}
