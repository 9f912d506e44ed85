// SPDX-License-Identifier: GPL-3.0-or-later
// What the address line may ask for: ?role= ?quality= ?nohud ?t=

export type Role = 'trainee' | 'instructor' | 'observer';
export type QualityName = 'low' | 'medium' | 'high' | 'ultra';

export interface Options {
  /** trainee drives the hands; instructor only pauses and resets; observer only looks. */
  role: Role;
  /** A fixed level, or null for automatic. */
  quality: QualityName | null;
  hud: boolean;
  /** Simulated second at which the picture stands still (for screenshots), or null. */
  freeze_at_s: number | null;
}

export function parse_options(search: string): Options {
  const q = new URLSearchParams(search);
  const role = q.get('role');
  const quality = q.get('quality');
  const t = q.get('t');
  return {
    role: role === 'instructor' || role === 'observer' ? role : 'trainee',
    quality: quality === 'low' || quality === 'medium' || quality === 'high' || quality === 'ultra' ? quality : null,
    hud: !q.has('nohud'),
    freeze_at_s: t !== null && t !== '' && Number.isFinite(Number(t)) ? Number(t) : null,
  };
}
