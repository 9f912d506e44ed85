// SPDX-License-Identifier: GPL-3.0-or-later
// How a picture can be shown to two eyes, and the angle between them. Without three.js, for pages that draw nothing.

export type StereoMode = 'off' | 'sbs' | 'anaglyph' | 'xr';
export const stereoModes: readonly StereoMode[] = ['off', 'sbs', 'anaglyph', 'xr'];

/** Operating microscopes: 22-25 mm between the beams at a working distance of 250-300 mm. */
export const usualAngleDeg = 5;
export const angleRangeDeg = [1, 9] as const;

export const clampAngle = (deg: number): number =>
  Math.max(angleRangeDeg[0], Math.min(angleRangeDeg[1], Number.isFinite(deg) ? deg : usualAngleDeg));
