// SPDX-License-Identifier: GPL-3.0-or-later
// What the address line may ask for: ?role= ?quality= ?nohud ?t= ?stereo= ?angle= ?icg

import { clamp_angle, type StereoMode, usual_angle_deg } from './stereo';

export type Role = 'trainee' | 'instructor' | 'observer';
export type QualityName = 'low' | 'medium' | 'high' | 'ultra';

export interface Options {
  /** trainee drives the hands; instructor watches, commands the scene's components and speaks to the trainee; observer only looks. */
  role: Role;
  /** A fixed level, or null for automatic. */
  quality: QualityName | null;
  hud: boolean;
  /** Simulated second at which the picture stands still (for screenshots), or null. */
  freeze_at_s: number | null;
  stereo: StereoMode;
  /** Between the eyes, at the focus. */
  angle_deg: number;
  /** Begins with the indocyanine-green picture. */
  infrared: boolean;
}

export function parse_options(search: string): Options {
  const q = new URLSearchParams(search);
  const role = q.get('role');
  const quality = q.get('quality');
  const t = q.get('t');
  const stereo = q.get('stereo');
  const angle = q.get('angle');
  return {
    role: role === 'instructor' || role === 'observer' ? role : 'trainee',
    quality: quality === 'low' || quality === 'medium' || quality === 'high' || quality === 'ultra' ? quality : null,
    hud: !q.has('nohud'),
    freeze_at_s: t !== null && t !== '' && Number.isFinite(Number(t)) ? Number(t) : null,
    stereo: stereo === 'sbs' || stereo === 'anaglyph' || stereo === 'xr' ? stereo : 'off',
    angle_deg: angle !== null && angle !== '' ? clamp_angle(Number(angle)) : usual_angle_deg,
    infrared: q.has('icg'),
  };
}
