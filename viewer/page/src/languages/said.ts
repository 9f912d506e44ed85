// SPDX-License-Identifier: GPL-3.0-or-later
// Texts that the engine says: of scenes and plugins, in English. They have translations in the same catalogues. Numbers
// have placeholders there: "Divide 12 strands" is looked up as "Divide {0} strands". So has a name at the end: "Largest
// force on: left rail" is looked up as "Largest force on: {name}" and "left rail". `insula texts` prints all of them.
// Messages that plugins make of numbers and names are in engine_messages.json; several may follow one another.
import engineMessages from './engine_messages.json';
import { patternOf } from './message_pattern';
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
export const localized = (n: string): string => fixed(Number(n), n.split('.')[1]?.length ?? 0);

/** A key of the catalogues with its arguments; null: it has no translation. */
export const saidWith = (key: string, values: TextValues): string | null =>
  hasTranslation(key) ? text(key, values) : null;

const messages = engineMessages.map((key) => {
  const { pattern, names } = patternOf(key);
  return { key, names, pattern: new RegExp(`^${pattern}(?: |$)`) };
});

/** A value in a message: a number, or the name of something. */
const valueText = (value: string): string =>
  /^\d+(?:\.\d+)?$/.test(value) ? localized(value) : said(value.replace(/_/g, ' '));

/** Messages of the engine, one after the other; null: a part of it is none that has a translation. */
function saidMessages(english: string): string | null {
  const out: string[] = [];
  for (let rest = english; rest !== '';) {
    const known = messages.find(({ pattern }) => pattern.test(rest));
    const found = known?.pattern.exec(rest);
    if (!known || !found) return null;
    const values = known.names.map((name, k) => [name, valueText(found[k + 1]!)]);
    const words = saidWith(known.key, Object.fromEntries(values) as TextValues);
    if (words === null) return null;
    out.push(words);
    rest = rest.slice(found[0].length);
  }
  return out.join(' ');
}

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
  if (name !== undefined && hasTranslation(named)) return text(named, { name: said(name) });
  return saidMessages(english) ?? english;
}
