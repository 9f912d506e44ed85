// SPDX-License-Identifier: GPL-3.0-or-later
// The channels' numbers of the newest frame, by channel, and how they are written.
import { type ChannelData, DataError, type Range } from './declarations';
import { fixed, withoutSign } from '../languages/numbers';
import { text } from '../languages/text';

export type Level = 'good' | 'high' | 'too_much' | 'none';

export class Channels {
  private readonly byId: Map<string, ChannelData>;
  private readonly size: number;
  private numbers = new Float32Array(0);

  constructor(readonly all: readonly ChannelData[]) {
    this.byId = new Map(all.map((c) => [c.id, c]));
    this.size = all.reduce((n, c) => n + c.size, 0);
  }

  /** Takes a frame's numbers. Throws DataError when they are not as many as declared; then nothing is known. */
  read(numbers: Float32Array): void {
    this.numbers = numbers.length === this.size ? Float32Array.from(numbers) : new Float32Array(0);
    if (numbers.length !== this.size)
      throw new DataError(`the frame has ${numbers.length} numbers of channels, the scene declares ${this.size}`);
  }

  find(id: string): ChannelData | null {
    return this.byId.get(id) ?? null;
  }

  /** SI; of a vector its length; null: not known now, or no such channel. */
  value(channel: ChannelData | string | null | undefined): number | null {
    const c = typeof channel === 'string' ? this.byId.get(channel) : channel;
    if (!c) return null;
    const v = c.size === 3 ? Math.hypot(...this.numbers.subarray(c.offset, c.offset + 3)) : this.numbers[c.offset];
    return v !== undefined && Number.isFinite(v) && this.numbers.length > 0 ? v : null;
  }
}

const dimensionless = (c: ChannelData): boolean => c.unit === '' || c.unit === '1';

/** Of things: a whole number without a unit, out of at most `max`. */
const isCount = (c: ChannelData): boolean => dimensionless(c) && c.display.unit === '' && c.display.digits === 0;

/** A share from 0 to max is drawn as a bar too; in per cent its max is 1 where none is declared. */
export const isShare = (c: ChannelData): boolean =>
  dimensionless(c) && c.min === 0 && (c.max !== null || c.display.unit === '%') && !isCount(c);

/** 0..1 of the bar of a share. */
export const barShare = (c: ChannelData, value: number | null): number =>
  value === null ? 0 : Math.max(0, Math.min(1, value / (c.max || 1)));

/** As displayed, without unit; a trickle backwards is 0, not -0. */
export function numberText(c: ChannelData, value: number | null): string {
  if (value === null) return '–';
  return withoutSign(fixed(value * c.display.scale, c.display.digits));
}

/** As displayed, with unit; of a count with what there was: "24 of 67". */
export function channelText(c: ChannelData, value: number | null): string {
  const n = numberText(c, value);
  if (value !== null && isCount(c) && c.max !== null) return text('{n} of {all}', { n, all: c.max });
  return value !== null && c.display.unit !== '' ? `${n} ${c.display.unit}` : n;
}

const inside = (v: number, [from, to]: Range): boolean => (from === null || v >= from) && (to === null || v <= to);

export function level(c: ChannelData, value: number | null): Level {
  if (value === null || !c.bands) return 'none';
  return inside(value, c.bands.good) ? 'good' : inside(value, c.bands.high) ? 'high' : 'too_much';
}

/** "superior.flow" of the group "superior" -> "flow". */
export const shortName = (c: ChannelData): string =>
  (c.group !== '' && c.name.startsWith(`${c.group}.`) ? c.name.slice(c.group.length + 1) : c.name).replace(
    /[_.]/g,
    ' ',
  );

/** In the order of the scene: channels by component. */
export function byComponent(channels: readonly ChannelData[]): Map<string, ChannelData[]> {
  const out = new Map<string, ChannelData[]>();
  for (const c of channels) out.set(c.component, [...(out.get(c.component) ?? []), c]);
  return out;
}
