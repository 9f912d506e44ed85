// SPDX-License-Identifier: GPL-3.0-or-later
// The messages of the case builder that catalogues translate are those that it says, and each message that it can say
// is translated or listed as one that stays in English.
import { afterEach, expect, it } from 'vitest';
import { builderMessages, builderSources, builderTexts, catalogue, englishMessages } from '../scripts/texts.mjs';
import { withoutNumbers } from '../src/languages/said';
import { setLanguage } from '../src/languages/text';
import { namedMessages } from '../src/studio/named_messages';
import { forThePage, inPageWords, translated } from '../src/studio/wording';

afterEach(() => setLanguage('en', {}));

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
  [/\(\{\d\}, \{\d\}, \{\d\}\)/, '{}'],
  [/ (handle|opening)s?([:;]) /, ' $1{}$2 '],
  [/ degrees, it runs/, ' degrees{}, it runs'],
  [/ taken (times|divided by) /, ' taken {} '],
];
const asWritten = (key: string): string => ofSeveral.reduce((all, [form, source]) => all.replace(form, source), key);

/** Put together of two texts, and of core/base/diagnostic.h. */
const fromElsewhere = ['Make the surface anew from a grid of {0} mm', 'did you mean "{name}"?'];

it('are said by the case builder', () => {
  const wrong = keys.filter((key) => !sources.includes(longestPiece(asWritten(key))));
  expect(wrong).toEqual(fromElsewhere);
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

const bare = (piece: string): string => piece.replace(/^[\s:;]+|[\s:;]+$/g, '');

it('are all translated, but for those that are listed', () => {
  const pieces = keys.map((key) => bare(longestPiece(asWritten(key)))).filter((piece) => piece.length >= 20);
  const has = (words: string): boolean => {
    const piece = bare(longestPiece(inPageWords(words)));
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

it('with names in them are those that the page looks for', () => {
  expect(keys.filter((key) => /\{[a-z]/.test(key)).sort()).toEqual([...namedMessages].sort());
});

it('are said with the names of lobes, vessels and exercises in the reader’s language', () => {
  setLanguage('de', catalogue('de'));
  for (const [english, german] of [
    [
      'Retractor 2 (right_frontal lobe): its shaft leans 71 degrees off the line of sight, and no arm could hold it ' +
        'there. Lean it by 60 degrees at most',
      'Retraktor 2 (Rechter Frontallappen): Sein Schaft neigt sich 71 Grad aus der Blickrichtung, und kein Arm ' +
        'könnte ihn dort halten. Neigen Sie ihn um höchstens 60 Grad',
    ],
    [
      'problem: Retractor 1 (frontal lobe) stands 2.4 mm deep in the vessel.',
      'Retraktor 1 (Frontallappen) steht 2,4 mm tief in: Gefäß.',
    ],
    [
      '2_aneurysm_dissection.xml, as it begins: arm_1 holds no lobe.',
      'Aneurysma freilegen, zu Beginn: Retraktor 1 hält keinen Lappen.',
    ],
    ['3_clipping.xml, scripted hands: the clip never touches the vessel', 'Den Hals clippen, gespielte Hände: '],
    [
      'branch_2 could not be cut off: the plane at (-1.5, 2, 3.0) does not meet the vessel',
      'Ast 2 konnte nicht abgeschnitten werden: Die Ebene bei (-1.5, 2, 3.0) trifft das Gefäß nicht',
    ],
    ['room to the left_frontal: -0.30 mm (before parting 1.20 mm)', 'Platz zu: Linker Frontallappen: -0,30 mm (vor '],
    [
      '--wall branch_3.young=2 MPa: the vessel has no region "branch_3"; did you mean "branch_2"?; it has parent, sac',
      'das Gefäß hat keine Region „Ast 3“; meinten Sie „Ast 2“?; es hat: Stammgefäß, Sack',
    ],
    ['--rule 3.clip=off: another part of the exercise needs it', 'Übung 3, „Clip“: Ein anderer Teil der Übung '],
  ])
    expect(forThePage(english!)).toContain(german);
});
