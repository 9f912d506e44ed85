// SPDX-License-Identifier: GPL-3.0-or-later
// Lists as the reader writes them: "a, b, c", "a, b und c", "a、b、c".
import { languageTag } from './text';

export function listed(items: readonly string[]): string {
  return new Intl.ListFormat(languageTag(), { type: 'conjunction', style: 'narrow' }).format(items);
}
