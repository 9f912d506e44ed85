// SPDX-License-Identifier: GPL-3.0-or-later
// What is heard of what: the only place that joins kinds of events, tools, materials and declared data with voices.
// Nothing here names a part of a scene. A plugin that emits one of these kinds, or declares such data, is heard.
import type { ChannelData, DrawableData, MaterialData } from '../step_data/declarations';
import { text } from '../languages/text';
import type { Hit } from './voices/contact';

/** What can be switched on and off by itself. */
export const groups = ['monitor', 'instruments', 'doppler', 'alarms', 'hints'] as const;
export type Group = (typeof groups)[number];

export const groupNames: Record<Group, { short: string; whole: string }> = {
  monitor: { short: text('Monitor'), whole: text('sounds of the patient monitor') },
  instruments: { short: text('Instruments'), whole: text('sounds of instruments and field') },
  doppler: { short: text('Doppler'), whole: text('sounds of the Doppler probe') },
  alarms: { short: text('Alarms'), whole: text('sounds of alarms') },
  hints: { short: text('Hints'), whole: text('sounds of hints') },
};

export type Voice = 'heart' | 'clip' | 'strand' | 'contact' | 'drop' | 'suction' | 'doppler' | 'alarm' | 'hint';

/** A voice's group, and how many of it may begin within a stretch of time. */
export const voices: Record<Voice, { group: Group; most: number; withinS: number }> = {
  heart: { group: 'monitor', most: 1, withinS: 0.2 },
  clip: { group: 'instruments', most: 4, withinS: 0.25 },
  strand: { group: 'instruments', most: 4, withinS: 0.15 },
  contact: { group: 'instruments', most: 4, withinS: 0.15 },
  drop: { group: 'instruments', most: 6, withinS: 0.25 },
  suction: { group: 'instruments', most: 8, withinS: 0.25 },
  doppler: { group: 'doppler', most: 4, withinS: 0.25 },
  alarm: { group: 'alarms', most: 2, withinS: 1 },
  hint: { group: 'hints', most: 1, withinS: 1 },
};

/** What parts: a strand or a piece of membrane, or a vessel with its blood; and by an edge or by a pull. */
export interface Parting {
  what: 'strand' | 'vein' | 'artery';
  by: 'cut' | 'torn';
}
export type ClipSound = 'shut' | 'released' | 'taken' | 'loaded';
/** As IEC 60601-1-8 has them. */
export type Priority = 'low' | 'medium' | 'high';

interface EventSound {
  /** by: where the kind does not say it, the event does: an edge is in a hand, and a pull is nobody's. */
  parts?: Pick<Parting, 'what'> & Partial<Parting>;
  clip?: ClipSound;
  alarm?: Priority;
}

/** By kind of event. What is not here is not heard. */
export const eventSounds: Readonly<Record<string, EventSound>> = {
  strand_cut: { parts: { what: 'strand', by: 'cut' } },
  strand_torn: { parts: { what: 'strand', by: 'torn' } },
  membrane_cut: { parts: { what: 'strand', by: 'cut' } },
  membrane_torn: { parts: { what: 'strand', by: 'torn' } },
  vein_parted: { parts: { what: 'vein' }, alarm: 'medium' },
  perforator_torn: { parts: { what: 'artery', by: 'torn' }, alarm: 'high' },
  perforator_shut: { alarm: 'medium' },
  clip_shut: { clip: 'shut' },
  clip_released: { clip: 'released' },
  clip_taken: { clip: 'taken' },
  clip_loaded: { clip: 'loaded' },
  rupture: { alarm: 'high' },
  bleeding_again: { alarm: 'high' },
  fault: { alarm: 'low' },
};

/** How something parted in this event; null: nothing did. */
export function partingOf({ kind, hand }: { kind: string; hand: number }): Parting | null {
  const parts = soundOf(kind)?.parts;
  return parts ? { by: hand >= 0 ? 'cut' : 'torn', ...parts } : null;
}

export const soundOf = (kind: string): EventSound | null =>
  Object.hasOwn(eventSounds, kind) ? eventSounds[kind]! : null;

/** A vital sign that declares its limits raises an alarm of this priority when it is far outside. */
export const channelAlarm: Priority = 'medium';
export const hasLimits = (c: ChannelData): boolean => c.shown === 'vital' && c.bands !== null;

/** A running clock of the exercise that has passed its limit. */
export const clockAlarm: Priority = 'high';

/** What sucks while it is active, by its kind. */
export const suctionKinds: ReadonlySet<string> = new Set(['suction']);

/** What a struck body is for the ear. */
type Ring = 'bone' | 'metal' | 'polymer' | 'soft';

/** By name. What is not here is soft if it is drawn as what gives way, and else like a hard polymer. */
const rings: Readonly<Record<string, Ring>> = {
  ...{ bone: 'bone', polymer: 'polymer' },
  ...{ steel: 'metal', steel_dark: 'metal', titanium: 'metal', cobalt: 'metal', gold: 'metal' },
  ...{ skin: 'soft', dura: 'soft', drape: 'soft', cotton: 'soft', silicone: 'soft' },
};
const softStyles: ReadonlySet<string> = new Set(['tissue', 'wall', 'fibre', 'sheet', 'fluid']);

function ringOf(material: string, materials: ReadonlyMap<string, MaterialData>): Ring {
  if (Object.hasOwn(rings, material)) return rings[material]!;
  return softStyles.has(materials.get(material)?.style ?? '') ? 'soft' : 'polymer';
}

/** What is heard when two materials meet; null: nothing. */
export function hitOf(a: string, b: string, materials: ReadonlyMap<string, MaterialData>): Hit | null {
  const both = [ringOf(a, materials), ringOf(b, materials)];
  if (both.every((r) => r === 'soft')) return null;
  return (['soft', 'bone', 'polymer'] as const).find((r) => both.includes(r)) ?? 'metal';
}

/** A body of fluid, such as a pool in the field. */
export const isPool = (d: DrawableData, materials: ReadonlyMap<string, MaterialData>): boolean =>
  d.kind === 'plane' && materials.get(d.material)?.style === 'fluid';

/** The channel whose value tells how fast fluid comes into a pool, by its declaration; '': none. */
export const inflowOf = (d: DrawableData, materials: ReadonlyMap<string, MaterialData>): string =>
  isPool(d, materials) ? d.rateChannel : '';

/** The pressure of what beats: a vital sign in pascals of the component that has the pulse; null: there is none. */
export function pressureOfPulse(channels: readonly ChannelData[], pulseChannel: string): ChannelData | null {
  const pulse = channels.find((c) => c.id === pulseChannel);
  const vital = (c: ChannelData) => c.component === pulse?.component && c.shown === 'vital' && c.unit === 'Pa';
  return channels.find(vital) ?? null;
}

/** What a Doppler probe hears, by the channels that its component declares. */
export interface DopplerChannels {
  /** Hz, positive towards the probe. */
  shift: ChannelData;
  depth: ChannelData | null;
  /** Not 0: the blood moves both ways. */
  mixed: ChannelData | null;
}

/** Every probe of a scene. */
export function dopplers(channels: readonly ChannelData[]): DopplerChannels[] {
  const named = (c: ChannelData, name: string) => c.id === `${c.component}.${name}`;
  const of = (component: string, name: string) =>
    channels.find((c) => c.component === component && named(c, name)) ?? null;
  return channels
    .filter((c) => c.unit === 'Hz' && named(c, 'doppler_shift'))
    .map((shift) => ({
      shift,
      depth: of(shift.component, 'doppler_depth'),
      mixed: of(shift.component, 'doppler_mixed'),
    }));
}
