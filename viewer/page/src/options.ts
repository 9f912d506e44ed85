// SPDX-License-Identifier: GPL-3.0-or-later
// What the address line may ask for: ?role= ?quality= ?nohud ?t= ?stereo= ?angle= ?icg ?nodepth ?ghost=

import { clampAngle, type StereoMode, usualAngleDeg } from './stereo_modes';

export type Role = 'trainee' | 'instructor' | 'observer';
/** From the fastest picture to the best one. */
export const qualityNames = ['draft', 'low', 'medium', 'high', 'ultra'] as const;
export type QualityName = (typeof qualityNames)[number];

export interface Options {
  /**
   * trainee drives the hands; instructor watches, commands the scene's components and speaks to the trainee; observer
   * only looks.
   */
  role: Role;
  /** A fixed level, or null for automatic. */
  quality: QualityName | null;
  hud: boolean;
  /** Simulated second at which the picture stands still (for screenshots), or null. */
  freezeAtS: number | null;
  stereo: StereoMode;
  /** Between the eyes, at the focus. */
  angleDeg: number;
  /** Begins with the indocyanine-green picture. */
  infrared: boolean;
  /** Plumb lines from tips to tissue. */
  depth: boolean;
  /** Name of a recorded session whose tools are drawn over the exercise; '': none. */
  ghost: string;
}

/** keptQuality: holds unless the address asks for another. */
export function parseOptions(search: string, keptQuality: QualityName | null = null): Options {
  const q = new URLSearchParams(search);
  const role = q.get('role');
  const quality = q.get('quality');
  const t = q.get('t');
  const stereo = q.get('stereo');
  const angle = q.get('angle');
  return {
    role: role === 'instructor' || role === 'observer' ? role : 'trainee',
    quality: qualityNames.find((name) => name === quality) ?? keptQuality,
    hud: !q.has('nohud'),
    freezeAtS: t !== null && t !== '' && Number.isFinite(Number(t)) ? Number(t) : null,
    stereo: stereo === 'sbs' || stereo === 'anaglyph' || stereo === 'xr' ? stereo : 'off',
    angleDeg: angle !== null && angle !== '' ? clampAngle(Number(angle)) : usualAngleDeg,
    infrared: q.has('icg'),
    depth: !q.has('nodepth'),
    ghost: q.get('ghost') ?? '',
  };
}
