// SPDX-License-Identifier: GPL-3.0-or-later
import { afterEach, expect, test } from 'vitest';

import { languageOf } from '../src/languages/languages';
import { fixed, significant, withoutSign } from '../src/languages/numbers';
import { said } from '../src/languages/said';
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

test('the language is the first wanted one that there is', () => {
  expect(languageOf(['it', 'de-CH', 'fr'])).toBe('de');
  expect(languageOf(['zh-Hans-CN'])).toBe('zh');
  expect(languageOf(['it'])).toBe('en');
  expect(languageOf([])).toBe('en');
});

test('what the engine says is translated whole, without its numbers, or by its name', () => {
  setLanguage('de', {
    'Divide {0} strands within {1} s': '{0} Stränge in {1} s durchtrennen',
    'Largest force on: {name}': 'Größte Kraft auf: {name}',
    'left rail': 'linke Schiene',
    'Stop the bleeding': 'Stillen Sie die Blutung',
  });
  expect(said('Stop the bleeding')).toBe('Stillen Sie die Blutung');
  expect(said('Divide 12 strands within 2.50 s')).toBe('12 Stränge in 2,50 s durchtrennen');
  expect(said('Largest force on: left rail')).toBe('Größte Kraft auf: linke Schiene');
  expect(said('1.7 N')).toBe('1,7 N');
  expect(said('No 1 knows this: text')).toBe('No 1 knows this: text');
  expect(said('constructor')).toBe('constructor');
});

test('numbers have the decimal sign of the language', () => {
  expect([fixed(1.5, 2), significant(0.0523, 2)]).toEqual(['1.50', '0.052']);
  setLanguage('fr', {});
  expect([fixed(1234.5, 2), significant(0.0523, 2)]).toEqual(['1234,50', '0,052']);
  expect(withoutSign(fixed(-0.001, 2))).toBe('0,00');
  expect(withoutSign(fixed(-0.01, 2))).toBe('-0,01');
});
