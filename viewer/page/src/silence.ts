// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a stream has fallen silent. What comes waits while a picture is drawn: where one takes a second, a second
// without news says nothing.
export function silent(nowMs: number, heardMs: number, limitMs: number, pictureMs: number): boolean {
  return nowMs - heardMs > Math.max(limitMs, 3 * pictureMs);
}
