// SPDX-License-Identifier: GPL-3.0-or-later
// The languages of the page, and which of them its reader wants: the one that was chosen, or the browser's.
import { browserStore } from '../browser_store';
import { type Catalogue, setLanguage } from './text';

/** By BCP 47 tag; each name in its own language. English is in the sources. */
export const languageNames = { en: 'English', de: 'Deutsch', fr: 'Français', es: 'Español', zh: '中文' } as const;
export type Language = keyof typeof languageNames;
export const languages = Object.keys(languageNames) as Language[];

const kept = 'insula.language';

/** Each is a file of its own, which only its readers load. */
const catalogues: Record<Exclude<Language, 'en'>, () => Promise<{ default: Catalogue }>> = {
  de: () => import('./catalogues/de.json'),
  fr: () => import('./catalogues/fr.json'),
  es: () => import('./catalogues/es.json'),
  zh: () => import('./catalogues/zh.json'),
};

/** The first wanted tag whose language there is: "de-CH" is German. English if there is none. */
export function languageOf(wanted: readonly string[]): Language {
  for (const tag of wanted) {
    const found = languages.find((l) => l === tag.toLowerCase().split('-')[0]);
    if (found) return found;
  }
  return 'en';
}

export function readersLanguage(): Language {
  const chosen = browserStore()?.getItem(kept);
  return languageOf([...(chosen ? [chosen] : []), ...navigator.languages]);
}

/** The page begins anew in that language. */
export function chooseLanguage(language: Language): void {
  browserStore()?.setItem(kept, language);
  window.location.reload();
}

/**
 * Loads the catalogue of the reader's language; then the page's own code, whose texts are looked up as it runs.
 * The page is English if the catalogue cannot be loaded.
 */
export async function inReadersLanguage(page: () => Promise<unknown>): Promise<void> {
  const language = readersLanguage();
  if (language !== 'en') {
    try {
      setLanguage(language, (await catalogues[language]()).default);
    } catch (e) {
      console.warn(`The texts in ${languageNames[language]} cannot be loaded: ${String(e)}`);
    }
  }
  await page();
}
