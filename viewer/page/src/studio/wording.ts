// SPDX-License-Identifier: GPL-3.0-or-later
// What the case builder says for its command line, as what to do on this page, in the reader's language.
import { languageTag } from '../languages/text';
import { saidWithNames } from './named_messages';

/** Options in messages of tools/case_builder, and what stands for them here. In this order. */
const here: readonly [RegExp, string][] = [
  [/^problem: /g, ''],
  [/ \((?:--(?:clip|spin|turn|keep|cut|threshold|pose|retractor)(?:, )?)+\)/g, ''],
  [/can be chosen with --clip/g, 'can be chosen'],
  [/choose another one with --clip/g, 'choose another one'],
  [/or with --cut\b/g, 'or here'],
  [/ \(--brain\)/g, ''],
  [/; --keep keeps more/g, ''],
  [/keep more of the vessel with --keep/g, 'keep more of the vessel'],
  [/, change it with --bleb/g, ''],
  [/where --pose moves it/g, 'where it was moved'],
  [
    /[Nn]ame a point on the wanted one with --seed "[^"]*", or take the largest with --keep-largest/g,
    'Put the seed into the wanted one',
  ],
  [/fewer vertices \(insula case wall FOLDER --vertices (\d+)( --on)?\)/g, 'choose $1 vertices and build again'],
  [/; --any-size takes it all the same/g, ''],
  [/insula case wall FOLDER --vertices (\d+)( --on)?/g, 'choose $1 vertices and build again'],
  [/insula case intake FOLDER INPUT --rebuild "([\d.]+ mm)" --on/g, 'make the surface anew from a grid of $1'],
  [/insula case wall FOLDER --neck "[^"]*"( --on)?/g, 'set the neck by two clicks and build again'],
  [/insula case wall FOLDER --neck \.\.\. --on/g, 'choose one of them'],
  [/: --neck "[^"]*" \(a point in the neck and the direction to the dome\)/g, ' by clicks'],
  [/ ?\(--neck, --neck-points\)/g, ' by two clicks'],
  [/ with --neck "[^"]*" or --neck-points/g, ' by two clicks'],
  [/ with --rebuild "([\d.]+ mm)"/g, ' of $1'],
  [/ ?\(--vertices (\d+)\)/g, ' ($1)'],
  [/: give --unit (\w+)/g, ': choose the unit $1'],
  [/with --unit if/g, 'if'],
  [
    /--neck-points turns the proposed neck, and none was found; give the whole plane with --neck/g,
    'the two points turn the proposed neck, and none was found; choose another neck',
  ],
  [/^--neck-points: /g, ''],
  [/^--wall [^:]*: /g, ''],
  [/^--rule (\d)\.(\w+)[^:]*: /g, 'Exercise $1, "$2": '],
  [/insula case place FOLDER --spin "45 deg" --on, or/g, 'turn or move the vessel, or'],
  [/cut shorter ones with --cut "[^"]*" \([^)]*\), once an end/g, 'cut shorter ones here'],
  [/a higher --threshold or less --smooth may/g, 'a higher threshold may'],
  [/; choose a larger --rebuild/g, '; is its unit right?'],
  [/, in the frame of the input see wall\/vessel\.json/g, ''],
  [/Make it anew from a grid: make the/g, 'Make the'],
  [/or make the scenes again: insula case scenes FOLDER/g, 'or build again'],
  [
    /or place: insula case scenes FOLDER --clip NAME --lift "1 mm" --slide "1 mm" --turn "10 deg"/g,
    'or move its blades',
  ],
  [
    /The arms, the hands and the microscope stand about the fissure[^;"]* or move the retractors\./g,
    'Move the retractors, or the vessel.',
  ],
  [/name a point in it with --seed/g, 'put the seed into it'],
  [
    /name a point in it \(--seed\) and take what is near it \(--around "[^"]*"\)/g,
    'put the seed into it and take a part',
  ],
];

/** A message in the words of this page, in English. */
export const inPageWords = (words: string): string =>
  here.reduce((all, [option, action]) => all.replace(option, action), words);

/** Needs no translation. */
const numbers = /^[\d., ]+$/;
const fileName = /^(\/[^:]*|[^\s:]+\.[a-z\d]+)$/i;
const place = /\(-?[\d.]+, -?[\d.]+, -?[\d.]+\)/g;
const anyPlace = '(0, 0, 0)';

/** A piece that is translated, or needs no translation. Places keep their signs. */
function known(words: string, say: (english: string) => string): string | null {
  if (fileName.test(words) || numbers.test(words)) return words;
  const places = words.match(place) ?? [];
  const english = words.replace(place, anyPlace);
  const out = say(english);
  return out === english ? null : out.replaceAll(anyPlace, () => places.shift() ?? anyPlace);
}

/**
 * A message that may have several sentences, or begin with the name of a file. say: gives a sentence in the reader's
 * language, or back as it is. null: a part of it has no translation.
 */
export function translated(words: string, say: (english: string) => string): string | null {
  const whole = known(words, say);
  if (whole !== null) return whole;
  for (const [sign, kept] of [
    [': ', 0],
    ['; ', 0],
    ['. ', 1],
  ] as const)
    for (let at = words.indexOf(sign); at >= 0; at = words.indexOf(sign, at + 1)) {
      const left = known(words.slice(0, at + kept), say);
      const right = left === null ? null : translated(words.slice(at + sign.length), say);
      if (right !== null) return left + sign.slice(kept) + right;
    }
  return null;
}

/**
 * A message of the case builder for somebody who has no command line, in the reader's language as far as
 * scripts/builder_texts.json has it. What has no translation stays in English as a whole.
 */
export function forThePage(words: string): string {
  const english = inPageWords(words);
  return languageTag() === 'en' ? english : (translated(english, saidWithNames) ?? english);
}

/** Why something was refused. */
export const reason = (e: unknown): string => (e instanceof Error ? forThePage(e.message) : String(e));
