// SPDX-License-Identifier: GPL-3.0-or-later
// The messages of the case builder that catalogues translate are those that it says, and each message that it can say
// is translated or listed as one that stays in English.
import { expect, it } from 'vitest';
import { builderMessages, builderSources, builderTexts, englishMessages } from '../scripts/texts.mjs';
import { withoutNumbers } from '../src/languages/said';
import { forThePage, inPageWords, translated } from '../src/studio/wording';

const sources = inPageWords(builderSources().replace(/\\"/g, '"'));
const keys = builderTexts().map((t) => t.key);

/** Between numbers, names and what the page says in other words. */
const longestPiece = (key: string): string =>
  key
    .split(/-?\{[^}]*\}|frontal|temporal|insula|largest|places?|[Pp]ut the seed|problem: |2_aneurysm/)
    .reduce((longest, piece) => (piece.length > longest.length ? piece : longest));

/** The builder writes them with one word or another, for one thing or for several. */
const ofSeveral: readonly [RegExp, string][] = [
  [/^\{0\} (triangle|place|small hole)s? /, '{} $1{} '],
  [/ (was|were) (turned|parted|filled|left out)\.$/, ' {} $2.'],
  [/that (was|were) there/, 'that {} there'],
  [/\(\{0\}, \{1\}, \{2\}\)/, '{}'],
];
const asWritten = (key: string): string => ofSeveral.reduce((all, [form, source]) => all.replace(form, source), key);

it('are said by the case builder', () => {
  const wrong = keys.filter((key) => !sources.includes(longestPiece(asWritten(key))));
  expect(wrong).toEqual([]);
});

it('are looked up without their numbers', () => {
  const part = 'The temporal was parted by up to 2.1 mm, so that it keeps 0.40 mm from the wall (before: -1.20 mm).';
  for (const words of [
    'The surface was open at 3 ends; they were closed by flat caps.',
    'If this is another one than meant, name a point in it with --seed.',
    part,
  ])
    expect(keys).toContain(withoutNumbers(forThePage(words)).key);
});

it('are all translated, but for those that are listed', () => {
  const pieces = keys.map(longestPiece).filter((piece) => piece.length >= 20);
  const has = (words: string): boolean => {
    const piece = longestPiece(inPageWords(words)).trim();
    return keys.some((key) => key.includes(piece)) || pieces.some((other) => piece.includes(other));
  };
  const english = builderMessages().filter((words) => !has(words));
  expect(english, 'node scripts/texts.mjs --missing: translate it, or list it in builder_english.json').toEqual(
    englishMessages(),
  );
});

it('are put together of their sentences, with the file’s name and the place as they are', () => {
  const words: Record<string, string> = {
    'holds no triangles': 'enthält keine Dreiecke',
    'The end at (0, 0, 0) was not flat.': 'Das Ende bei (0, 0, 0) war nicht eben.',
    'It was cut.': 'Es wurde abgeschnitten.',
  };
  const say = (english: string): string => words[english] ?? english;
  expect(translated('/data/input.stl: holds no triangles', say)).toBe('/data/input.stl: enthält keine Dreiecke');
  expect(translated('The end at (-1.5, 2, 3.0) was not flat. It was cut.', say)).toBe(
    'Das Ende bei (-1.5, 2, 3.0) war nicht eben. Es wurde abgeschnitten.',
  );
  expect(translated('The end at (-1.5, 2, 3.0) was not flat. Nobody knows why.', say)).toBeNull();
});
