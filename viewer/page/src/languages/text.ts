// SPDX-License-Identifier: GPL-3.0-or-later
// Texts of the page in the language of its reader. A text is written once in the source, in English, as an ICU message:
// text("{count, plural, one {# run} other {# runs}}", {count}). The catalogue of a language maps it to a translation.
// A text that a catalogue lacks is shown in English.
import { IntlMessageFormat } from 'intl-messageformat';

/** Values of a message's arguments, by name. */
export type TextValues = Readonly<Record<string, string | number>>;

/** Translations by English message. */
export type Catalogue = Readonly<Record<string, string>>;

let tag = 'en';
let catalogue: Catalogue = {};
const formats = new Map<string, IntlMessageFormat>();

/** The language of all texts from now on. languageTag: BCP 47, such as "de". */
export function setLanguage(languageTag: string, translations: Catalogue): void {
  tag = languageTag;
  catalogue = translations;
  formats.clear();
  if (typeof document !== 'undefined') document.documentElement.lang = languageTag;
}

/** The BCP 47 tag of the language, for Intl.NumberFormat and for the lang attribute. */
export function languageTag(): string {
  return tag;
}

/** Whether the catalogue has a translation of a message. */
export function hasTranslation(english: string): boolean {
  return Object.hasOwn(catalogue, english);
}

/** The English message in the language of the page, with its arguments filled in. */
export function text(english: string, values: TextValues = {}): string {
  let format = formats.get(english);
  if (!format) {
    format = new IntlMessageFormat(hasTranslation(english) ? catalogue[english] : english, tag, undefined, {
      ignoreTag: true,
    });
    formats.set(english, format);
  }
  return String(format.format(values));
}
