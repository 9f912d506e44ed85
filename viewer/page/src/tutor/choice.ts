// SPDX-License-Identifier: GPL-3.0-or-later
// How somebody wants to be told of a hint, kept by the browser from visit to visit. The sound of hints is a group of
// the page's sounds (sound/settings.ts).

export interface CueChoice {
  words: boolean;
  arrow: boolean;
}

const key = 'insula.tutor';

type Store = Pick<Storage, 'getItem' | 'setItem'>;

/** What a browser keeps may be missing, forbidden or anything: each wrong part is as at first, which is on. */
export function readCueChoice(store: Store | null): CueChoice {
  const out = { words: true, arrow: true };
  try {
    const kept: unknown = JSON.parse(store?.getItem(key) ?? 'null');
    if (typeof kept !== 'object' || kept === null) return out;
    const { words, arrow } = kept as Record<string, unknown>;
    if (typeof words === 'boolean') out.words = words;
    if (typeof arrow === 'boolean') out.arrow = arrow;
  } catch {
    // As at first.
  }
  return out;
}

export function writeCueChoice(store: Store | null, choice: CueChoice): void {
  try {
    store?.setItem(key, JSON.stringify(choice));
  } catch {
    // A full or forbidden store: the choice lasts as long as the page.
  }
}
