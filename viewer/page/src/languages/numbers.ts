// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as the reader writes them: decimal sign, groups of digits, dates. Units stay those of the SI.
import { languageTag } from './text';

const formats = new Map<string, Intl.NumberFormat>();

/** With so many decimals: "1.50", "1,50". No thin groups, since most numbers stand in columns. */
export function fixed(value: number, digits: number): string {
  const key = `${languageTag()} ${digits}`;
  let format = formats.get(key);
  if (!format) {
    const options = { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false };
    formats.set(key, (format = new Intl.NumberFormat(languageTag(), options)));
  }
  return format.format(value);
}

/** With so many significant digits at most and no zeros at the end: "3.2", "0,05". */
export function significant(value: number, digits: number): string {
  return Intl.NumberFormat(languageTag(), { maximumSignificantDigits: digits, useGrouping: false }).format(value);
}

/** A value that is rounded to 0 has no sign. */
export function withoutSign(number: string): string {
  return /[1-9]/.test(number) ? number : number.replace(/^[-−]/, '');
}

/** "1.50 mm"; without a unit the number alone. */
export function quantity(number: string, unit: string): string {
  return unit === '' ? number : `${number} ${unit}`;
}

/** A day and a time of day, of the reader's clock. */
export function momentText(when: Date): string {
  return when.toLocaleString(languageTag(), { dateStyle: 'medium', timeStyle: 'short' });
}

/** The same of a recording's ISO time; as it is if it is none. */
export function beganText(iso: string): string {
  const when = new Date(iso);
  return Number.isNaN(when.getTime()) ? iso : momentText(when);
}
