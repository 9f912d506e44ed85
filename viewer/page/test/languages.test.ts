// SPDX-License-Identifier: GPL-3.0-or-later
import { afterEach, expect, test } from 'vitest';

import { languageTag, setLanguage, text } from '../src/languages/text';

const runs = '{count, plural, one {# run} other {# runs}}';

afterEach(() => {
  setLanguage('en', {});
});

test('a text without a translation is English, with plurals and numbers', () => {
  expect(text(runs, { count: 1 })).toBe('1 run');
  expect(text(runs, { count: 1200 })).toBe('1,200 runs');
});

test('a catalogue replaces texts, numbers follow the language', () => {
  setLanguage('de', { [runs]: '{count, plural, one {# Durchgang} other {# Durchgänge}}' });
  expect(languageTag()).toBe('de');
  expect(text(runs, { count: 1200 })).toBe('1.200 Durchgänge');
  expect(text('Continue')).toBe('Continue');
});
