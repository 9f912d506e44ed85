// SPDX-License-Identifier: GPL-3.0-or-later
import { afterEach, expect, test } from 'vitest';

import engineMessages from '../src/languages/engine_messages.json';
import { pluginSources } from '../scripts/texts.mjs';
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

test('messages that the engine makes of numbers and names are translated, several in a row', () => {
  setLanguage('de', {
    'A remnant stands above {0} % of the neck (grade {1}).': 'Ein Rest steht über {0} % des Halses (Grad {1}).',
    'The {name} branch flows at {0} %.': 'Ast {name}: {0} % seines Flusses.',
    'Clip {name} loaded': 'Clip {name} geladen',
    'left a2': 'linke A2',
  });
  expect(said('A remnant stands above 40 % of the neck (grade 3). The left a2 branch flows at 7.5 %.')).toBe(
    'Ein Rest steht über 40 % des Halses (Grad 3). Ast linke A2: 7,5 % seines Flusses.',
  );
  expect(said('Clip fenestrated_3_5_stem_90 loaded')).toBe('Clip fenestrated 3 5 stem 90 geladen');
  expect(said('The neck is shut: take the temporary clip off.')).toBe('The neck is shut: take the temporary clip off.');
  const half = 'The left a2 branch flows at 7 %. And nobody knows this.';
  expect(said(half)).toBe(half);
});

test('each of these messages is one of a plugin', () => {
  const bare = (words: string) => words.replace(/\{[:.\w]*\}/g, '{}');
  const all = bare(pluginSources());
  expect(engineMessages.filter((message) => !all.includes(bare(message)))).toEqual([]);
});

test('numbers have the decimal sign of the language', () => {
  expect([fixed(1.5, 2), significant(0.0523, 2)]).toEqual(['1.50', '0.052']);
  setLanguage('fr', {});
  expect([fixed(1234.5, 2), significant(0.0523, 2)]).toEqual(['1234,50', '0,052']);
  expect(withoutSign(fixed(-0.001, 2))).toBe('0,00');
  expect(withoutSign(fixed(-0.01, 2))).toBe('-0,01');
});
