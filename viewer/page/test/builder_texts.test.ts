// SPDX-License-Identifier: GPL-3.0-or-later
// The messages of the case builder that catalogues translate are those that it says.
import { readdirSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { expect, it } from 'vitest';
import { builderTexts } from '../scripts/texts.mjs';
import { withoutNumbers } from '../src/languages/said';
import { forThePage } from '../src/studio/wording';

const folder = fileURLToPath(new URL('../../../tools/case_builder/', import.meta.url));

/** All sources, with texts that go on over several lines in one piece. */
const said = readdirSync(folder)
  .filter((file) => file.endsWith('.cpp') && !file.endsWith('_test.cpp'))
  .map((file) => readFileSync(folder + file, 'utf8').replace(/"\s*\n\s*"/g, ''))
  .join('\n');

/** Between numbers, names and what the page says in other words. */
const longestPiece = (key: string): string =>
  key
    .split(/-?\{\d+\}|frontal|temporal|insula|largest|places?|put the seed/)
    .reduce((longest, piece) => (piece.length > longest.length ? piece : longest));

it('are said by the case builder', () => {
  const wrong = builderTexts().filter(({ key }) => !said.includes(longestPiece(key)));
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
