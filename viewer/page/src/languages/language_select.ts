// SPDX-License-Identifier: GPL-3.0-or-later
// The choice of the page's language. A change loads the page anew.
import { el } from '../hud/dom';
import { chooseLanguage, type Language, languageNames, languages } from './languages';
import { languageTag, text } from './text';

export function languageSelect(): HTMLSelectElement {
  const select = el('select', { class: 'language', title: text('language'), 'aria-label': text('language') });
  // Names are in their own language, and are read so.
  for (const l of languages) select.append(el('option', { value: l, lang: l }, languageNames[l]));
  select.value = languageTag();
  select.onchange = () => chooseLanguage(select.value as Language);
  return select;
}
