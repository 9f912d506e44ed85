// SPDX-License-Identifier: GPL-3.0-or-later
import { describe, expect, it } from 'vitest';
import { keptQuality, keepQuality } from '../src/kept_quality';
import { hexOf, keepPalette, keptPalette, palettes } from '../src/palette';
import type { Palette } from '../src/palette';

type Triple = [number, number, number];

const linear = (c: number): number => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
const times = (m: readonly Triple[], v: Triple): Triple =>
  m.map((row) => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]) as Triple;

/** Linear RGB as somebody sees it without one kind of cones: Machado, Oliveira, Fernandes 2009, severity 1. */
const eyes: Record<string, readonly Triple[]> = {
  usual: [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ],
  deuteranopia: [
    [0.367322, 0.860646, -0.227968],
    [0.280085, 0.672501, 0.047413],
    [-0.01182, 0.04294, 0.968881],
  ],
  protanopia: [
    [0.152286, 1.052583, -0.204868],
    [0.114503, 0.786281, 0.099216],
    [-0.003882, -0.048116, 1.051998],
  ],
};

/** CIE 1976 L*a*b* of linear sRGB, white D65. */
function lab(rgb: Triple): Triple {
  const toXyz: Triple[] = [
    [0.4124, 0.3576, 0.1805],
    [0.2126, 0.7152, 0.0722],
    [0.0193, 0.1192, 0.9505],
  ];
  const [x, y, z] = times(toXyz, rgb.map((c) => Math.min(1, Math.max(0, c))) as Triple);
  const f = (t: number) => (t > 0.008856 ? Math.cbrt(t) : 7.787 * t + 16 / 116);
  const [fx, fy, fz] = [f(x / 0.9505), f(y), f(z / 1.089)];
  return [116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)];
}

function seen(colour: string, eye: string): Triple {
  const hex = hexOf(colour);
  const rgb = [hex >> 16, (hex >> 8) & 255, hex & 255].map((c) => linear(c / 255)) as Triple;
  return lab(times(eyes[eye]!, rgb));
}

/** The smallest difference of two of the colours, CIE 1976. */
function leastDifference(p: Palette, eye: string): number {
  const c = [p.good, p.high, p.bad].map((one) => seen(one, eye));
  const between = (a: Triple, b: Triple) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  return Math.min(between(c[0]!, c[1]!), between(c[1]!, c[2]!), between(c[0]!, c[2]!));
}

describe('the colours for colour-blind eyes', () => {
  // About 2.3 is a difference that is just seen (Mahy and others 1994).
  it('are told apart without red or green cones, and better than the usual ones', () => {
    for (const eye of ['usual', 'deuteranopia', 'protanopia'])
      expect(leastDifference(palettes['colour-blind'], eye), eye).toBeGreaterThan(30);
    for (const eye of ['deuteranopia', 'protanopia'])
      expect(leastDifference(palettes['colour-blind'], eye), eye).toBeGreaterThan(leastDifference(palettes.usual, eye));
  });
});

describe('what the browser keeps', () => {
  const kept = new Map<string, string>();
  const store = { getItem: (k: string) => kept.get(k) ?? null, setItem: (k: string, v: string) => void kept.set(k, v) };
  it('may be missing, wrong or right', () => {
    expect(keptPalette(null)).toBe('usual');
    expect(keptQuality(store)).toBeNull();
    kept.set('insula.colours', 'pink').set('insula.quality', '9');
    expect([keptPalette(store), keptQuality(store)]).toEqual(['usual', null]);
    keepPalette(store, 'colour-blind');
    keepQuality(store, 'low');
    expect([keptPalette(store), keptQuality(store)]).toEqual(['colour-blind', 'low']);
    keepQuality(store, null);
    expect(keptQuality(store)).toBeNull();
  });
});
