// SPDX-License-Identifier: GPL-3.0-or-later
// What a person has chosen to hear, kept by the browser from visit to visit.
import { type Group, groups } from './table';

export interface SoundSettings {
  on: boolean;
  /** 0 to 1. */
  volume: number;
  groups: Record<Group, boolean>;
}

/** Off until it is asked for: several pages may show one session in one room. */
export const defaultSettings = (): SoundSettings => ({
  on: false,
  volume: 0.7,
  groups: { monitor: true, instruments: true, doppler: true, alarms: true, hints: true },
});

const key = 'insula.sound';

type Store = Pick<Storage, 'getItem' | 'setItem'>;

/** What a browser keeps may be missing, forbidden or anything: each wrong part is as at first. */
export function readSettings(store: Store | null): SoundSettings {
  const out = defaultSettings();
  let kept: unknown;
  try {
    kept = JSON.parse(store?.getItem(key) ?? 'null');
  } catch {
    return out;
  }
  if (typeof kept !== 'object' || kept === null) return out;
  const { on, volume, groups: chosen } = kept as Record<string, unknown>;
  if (typeof on === 'boolean') out.on = on;
  if (typeof volume === 'number' && volume >= 0 && volume <= 1) out.volume = volume;
  if (typeof chosen === 'object' && chosen !== null)
    for (const g of groups) {
      const value = (chosen as Record<string, unknown>)[g];
      if (typeof value === 'boolean') out.groups[g] = value;
    }
  return out;
}

export function writeSettings(store: Store | null, settings: SoundSettings): void {
  try {
    store?.setItem(key, JSON.stringify(settings));
  } catch {
    // A full or forbidden store: the choice lasts as long as the page.
  }
}
