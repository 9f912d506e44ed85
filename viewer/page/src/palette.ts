// SPDX-License-Identifier: GPL-3.0-or-later
// The colours that say good, attention and bad, in panels, curves and marks. Those for colour-blind eyes are sky blue,
// yellow and vermillion of Okabe and Ito, "Color Universal Design" (2008).
import { browserStore } from './browser_store';

/** As CSS writes them. */
export interface Palette {
  good: string;
  high: string;
  bad: string;
}

export const paletteNames = ['usual', 'colour-blind'] as const;
export type PaletteName = (typeof paletteNames)[number];

export const palettes: Readonly<Record<PaletteName, Palette>> = {
  usual: { good: '#5fcf92', high: '#f0b64a', bad: '#f2604f' },
  'colour-blind': { good: '#56b4e9', high: '#f0e442', bad: '#d55e00' },
};

const key = 'insula.colours';

/** What a browser keeps may be anything. */
export const keptPalette = (store: Pick<Storage, 'getItem'> | null): PaletteName =>
  paletteNames.find((name) => name === store?.getItem(key)) ?? 'usual';

export function keepPalette(store: Pick<Storage, 'setItem'> | null, name: PaletteName): void {
  try {
    store?.setItem(key, name);
  } catch {
    // A full or forbidden store: the choice lasts as long as the page.
  }
}

/** The colours of this page, from its beginning on. */
export const palette: Palette = palettes[keptPalette(browserStore())];

/** For materials. */
export const hexOf = (colour: string): number => Number.parseInt(colour.slice(1), 16);

/** Gives the style sheets these colours. The usual ones are theirs already. */
export function applyPalette(name: PaletteName): void {
  const style = document.documentElement.style;
  for (const [what, colour] of Object.entries(palettes[name]))
    if (name === 'usual') style.removeProperty(`--${what}`);
    else style.setProperty(`--${what}`, colour);
}
