// SPDX-License-Identifier: GPL-3.0-or-later
// The picture quality that somebody has chosen, kept by the browser from visit to visit.
import { type QualityName, qualityNames } from './options';

const key = 'insula.quality';

/** null: automatic. */
export const keptQuality = (store: Pick<Storage, 'getItem'> | null): QualityName | null =>
  qualityNames.find((name) => name === store?.getItem(key)) ?? null;

export function keepQuality(store: Pick<Storage, 'setItem'> | null, name: QualityName | null): void {
  try {
    store?.setItem(key, name ?? '');
  } catch {
    // A full or forbidden store: the choice lasts as long as the page.
  }
}
