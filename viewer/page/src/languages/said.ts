// SPDX-License-Identifier: GPL-3.0-or-later
// Texts that the engine says: of scenes and plugins, in English. They have translations in the same catalogues. Numbers
// have placeholders there: "Divide 12 strands" is looked up as "Divide {0} strands". So has a name at the end: "Largest
// force on: left rail" is looked up as "Largest force on: {name}" and "left rail". `insula texts` prints all of them.
import { fixed } from './numbers';
import { hasTranslation, languageTag, text, type TextValues } from './text';

const number = /(?<![\p{L}\d._])\d+(?:\.\d+)?(?![\p{L}\d_])/gu;
const nameAtEnd = /^(.*: )([a-z][a-z0-9 ]*)$/;
const measured = /^\{0\} ?(mm|N|deg|%|s|ml|mmHg)$/;

/** A text with placeholders, and the numbers that were in it. */
export function withoutNumbers(english: string): { key: string; numbers: string[] } {
  const numbers: string[] = [];
  const key = english.replace(number, (n) => `{${numbers.push(n) - 1}}`);
  return { key, numbers };
}

/** Whether a text without its numbers is a unit at most, which needs no translation. */
export const isMeasured = (key: string): boolean => key === '{0}' || measured.test(key);

/** As many decimals as were written. */
const localized = (n: string): string => fixed(Number(n), n.split('.')[1]?.length ?? 0);

/** A key of the catalogues with its arguments; null: it has no translation. */
export const saidWith = (key: string, values: TextValues): string | null =>
  hasTranslation(key) ? text(key, values) : null;

/** A title, a goal, a fault, a name: in the reader's language, or as it is if there is no translation. */
export function said(english: string): string {
  if (languageTag() === 'en' || english === '') return english;
  if (hasTranslation(english)) return text(english);
  const { key, numbers } = withoutNumbers(english);
  if (numbers.length > 0 && isMeasured(key)) return key.replace('{0}', localized(numbers[0]!));
  if (numbers.length > 0 && hasTranslation(key))
    return text(key, Object.fromEntries(numbers.map((n, k) => [String(k), localized(n)])));
  const [, before, name] = nameAtEnd.exec(english) ?? [];
  const named = `${before}{name}`;
  if (name === undefined || !hasTranslation(named)) return english;
  return text(named, { name: said(name) });
}
