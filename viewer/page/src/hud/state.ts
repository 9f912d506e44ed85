// SPDX-License-Identifier: GPL-3.0-or-later
// What the engine says of the exercise (hud_json of a frame), read with care: it is text from outside.

export interface VesselView {
  id: string;
  pressure_mmHg: number;
  flow_mL_min: number;
  /** Of the flow at rest; null where nothing flows at rest. */
  flow_percent: number | null;
  /** Narrowest cross-section, of its own at rest. */
  lumen_percent: number;
  dye: number;
}

export interface BloodState {
  open: boolean;
  rate_mL_min: number;
  lost_mL: number;
  height_m: number;
  origin: [number, number, number];
  up: [number, number, number];
  radius_m: number;
}

export interface ClipView {
  id: string;
  state: 'tray' | 'held' | 'free';
  holder: string;
  force_N: number;
  applications: number;
  temporary: boolean;
}

export interface TimerView {
  id: string;
  text: string;
  elapsed_s: number;
  limit_s: number;
  running: boolean;
}

export interface MeasureView {
  id: string;
  text: string;
  value: number;
  unit: string;
  /** 1 good, 0 neutral, -1 bad. */
  good: number;
}

export interface HudState {
  goals: { id: string; text: string; done: boolean }[];
  faults: { id: string; text: string; count: number }[];
  strands_left: number | null;
  strands_total: number | null;
  message: string;
  state: string;
  elapsed_s: number | null;
  heart_phase: number | null;
  vessels: VesselView[];
  blood: BloodState | null;
  clips: ClipView[];
  timers: TimerView[];
  measures: MeasureView[];
  /** Tool in each hand, by id. */
  hands: { hand: string; tool: string }[];
}

const finite = (v: unknown): number | null => (typeof v === 'number' && Number.isFinite(v) ? v : null);
const list = (v: unknown): any[] => (Array.isArray(v) ? v.filter((x) => typeof x === 'object' && x !== null) : []);
const text = (v: unknown): string => (v === null || v === undefined ? '' : String(v));

function triple(v: unknown): [number, number, number] | null {
  return Array.isArray(v) && v.length === 3 && v.every((x) => finite(x) !== null) ? (v as [number, number, number]) : null;
}

function blood(v: any): BloodState | null {
  if (typeof v !== 'object' || v === null) return null;
  const origin = triple(v.origin), up = triple(v.up);
  if (!origin || !up || Math.hypot(...up) < 1e-6) return null;
  return {
    open: v.open === true, rate_mL_min: finite(v.rate_mL_min) ?? 0, lost_mL: finite(v.lost_mL) ?? 0, height_m: finite(v.height_m) ?? 0,
    origin, up, radius_m: Math.max(1e-3, finite(v.radius_m) ?? 0.02),
  };
}

export function parse_hud(json: string): HudState | null {
  let j: any;
  try {
    j = JSON.parse(json);
  } catch {
    return null;
  }
  if (typeof j !== 'object' || j === null) return null;
  return {
    goals: list(j.goals).map((g) => ({ id: text(g.id), text: text(g.text ?? g.id), done: g.done === true })),
    faults: list(j.faults).map((f) => ({ id: text(f.id), text: text(f.text ?? f.id), count: finite(f.count) ?? 0 })),
    strands_left: finite(j.strands_left),
    strands_total: finite(j.strands_total),
    message: text(j.message),
    state: text(j.state),
    elapsed_s: finite(j.elapsed_s),
    heart_phase: finite(j.heart_phase),
    vessels: list(j.vessels).map((v) => ({
      id: text(v.id), pressure_mmHg: finite(v.pressure_mmHg) ?? 0, flow_mL_min: finite(v.flow_mL_min) ?? 0,
      flow_percent: finite(v.flow_percent), lumen_percent: finite(v.lumen_percent) ?? 100, dye: finite(v.dye) ?? 0,
    })),
    blood: blood(j.blood),
    clips: list(j.clips).map((c) => ({
      id: text(c.id), state: c.state === 'held' || c.state === 'free' ? c.state : 'tray', holder: text(c.holder), force_N: finite(c.force_N) ?? 0,
      applications: finite(c.applications) ?? 0, temporary: c.temporary === true,
    })),
    timers: list(j.timers).map((t) => ({ id: text(t.id), text: text(t.text ?? t.id), elapsed_s: finite(t.elapsed_s) ?? 0, limit_s: finite(t.limit_s) ?? 0, running: t.running === true })),
    measures: list(j.measures).map((m) => ({ id: text(m.id), text: text(m.text ?? m.id), value: finite(m.value) ?? NaN, unit: text(m.unit), good: Math.sign(finite(m.good) ?? 0) })),
    hands: list(j.hands).map((h) => ({ hand: text(h.hand), tool: text(h.tool) })),
  };
}

/** m:ss.s */
export function clock_text(seconds: number): string {
  // Rounded first, so that 59.97 becomes 1:00.0 and not 0:60.0.
  const tenths = Math.round(Math.max(0, seconds) * 10);
  return `${Math.floor(tenths / 600)}:${((tenths % 600) / 10).toFixed(1).padStart(4, '0')}`;
}

/** Width of a force bar, 0..1: square root, so that the tens of millinewtons of good retraction are seen beside the device's 3.3 N. */
export function force_bar(newtons: number): number {
  return Math.sqrt(Math.min(1, Math.max(0, newtons) / 3.3));
}

/** Measured retraction of brain stays below about 0.2 N; blunt dissection about as much; half a newton is rough. */
export function force_level(newtons: number): 'good' | 'high' | 'too_much' {
  return newtons < 0.2 ? 'good' : newtons < 0.5 ? 'high' : 'too_much';
}
