// SPDX-License-Identifier: GPL-3.0-or-later
// The messages of the case builder that catalogues translate are those that it says.
import { expect, it } from 'vitest';
import { builderSources, builderTexts } from '../scripts/texts.mjs';
import { withoutNumbers } from '../src/languages/said';
import { forThePage } from '../src/studio/wording';

const sources = builderSources();

/** Between numbers, names and what the page says in other words. */
const longestPiece = (key: string): string =>
  key
    .split(/-?\{\d+\}|frontal|temporal|insula|largest|places?|put the seed/)
    .reduce((longest, piece) => (piece.length > longest.length ? piece : longest));

it('are said by the case builder', () => {
  const wrong = builderTexts().filter(({ key }) => !sources.includes(longestPiece(key)));
  expect(wrong.map(({ key }) => key)).toEqual([]);
});

it('are looked up without their numbers', () => {
  const keys = builderTexts().map((t) => t.key);
  const part = 'The temporal was parted by up to 2.1 mm, so that it keeps 0.40 mm from the wall (before: -1.20 mm).';
  for (const words of [
    'The surface was open at 3 ends; they were closed by flat caps.',
    'If this is another one than meant, name a point in it with --seed.',
    part,
  ])
    expect(keys).toContain(withoutNumbers(forThePage(words)).key);
});
