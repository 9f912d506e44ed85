// SPDX-License-Identifier: GPL-3.0-or-later
import { expect, it } from 'vitest';
import { silent } from '../src/silence';

it('tells silence from pictures that take long', () => {
  expect(silent(5000, 4100, 1000, 16)).toBe(false);
  expect(silent(5000, 3900, 1000, 16)).toBe(true);
  // One picture a second: news of the second before is no silence, three pictures without any is.
  expect(silent(5000, 3500, 1000, 1000)).toBe(false);
  expect(silent(7000, 3500, 1000, 1000)).toBe(true);
  expect(silent(5000, -1e9, 1000, 1000)).toBe(true);
});
