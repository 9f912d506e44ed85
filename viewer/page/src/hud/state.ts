// SPDX-License-Identifier: GPL-3.0-or-later
// What the engine says of the exercise (hud_json of a frame), read with care: it is text from outside.

export interface HudState {
  goals: { id: string; text: string; done: boolean }[];
  faults: { id: string; text: string; count: number }[];
  strands_left: number | null;
  strands_total: number | null;
  message: string;
  state: string;
  elapsed_s: number | null;
}

export function parse_hud(text: string): HudState | null {
  let j: any;
  try {
    j = JSON.parse(text);
  } catch {
    return null;
  }
  if (typeof j !== 'object' || j === null) return null;
  const list = (v: unknown): any[] => (Array.isArray(v) ? v.filter((x) => typeof x === 'object' && x !== null) : []);
  const number = (v: unknown) => (typeof v === 'number' && Number.isFinite(v) ? v : null);
  return {
    goals: list(j.goals).map((g) => ({ id: String(g.id ?? ''), text: String(g.text ?? g.id ?? ''), done: g.done === true })),
    faults: list(j.faults).map((f) => ({ id: String(f.id ?? ''), text: String(f.text ?? f.id ?? ''), count: number(f.count) ?? 0 })),
    strands_left: number(j.strands_left),
    strands_total: number(j.strands_total),
    message: String(j.message ?? ''),
    state: String(j.state ?? ''),
    elapsed_s: number(j.elapsed_s),
  };
}

/** m:ss.s */
export function clock_text(seconds: number): string {
  const s = Math.max(0, seconds);
  return `${Math.floor(s / 60)}:${(s % 60).toFixed(1).padStart(4, '0')}`;
}

/** Width of a force bar, 0..1: square root, so that the tens of millinewtons of good retraction are seen beside the device's 3.3 N. */
export function force_bar(newtons: number): number {
  return Math.sqrt(Math.min(1, Math.max(0, newtons) / 3.3));
}

/** Measured retraction of brain stays below about 0.2 N; blunt dissection about as much; half a newton is rough. */
export function force_level(newtons: number): 'good' | 'high' | 'too_much' {
  return newtons < 0.2 ? 'good' : newtons < 0.5 ? 'high' : 'too_much';
}
