// SPDX-License-Identifier: GPL-3.0-or-later
// Turns what comes from the engine, events and frames, into sounds. It knows declarations and the table of sounds, and
// no part of a scene.
import type { Bundle } from '../bundle_types';
import type { TimerView } from '../hud/state';
import type { RenderFrame, SimEvent } from '../lcm';
import { Channels, level } from '../step_data/channels';
import { type ChannelData, DataError } from '../step_data/declarations';
import { Alarms } from './alarms';
import { Beats } from './beats';
import type { Desk } from './desk';
import { Impacts } from './impacts';
import { Poisson } from './poisson';
import { Surroundings } from './surroundings';
import { channelAlarm, clockAlarm, dopplers, hasLimits, inflowOf, pressureOfPulse } from './table';
import { type DopplerChannels, partingOf, type Priority, soundOf } from './table';
import { dropsPerSecond } from './voices/bleeding';
import type { Flow } from './voices/doppler';
import { bubbleRate } from './voices/suction';

/** Of simulated time between two frames; more was lost or skipped, s. */
const longestS = 0.2;

/** Of an event. */
export type Heard = Pick<SimEvent, 'kind' | 'sim_time_s' | 'hand'>;

export class Listener {
  private readonly channels: Channels;
  private readonly pulse: string;
  private readonly pressure: ChannelData | null;
  private readonly inflows: string[];
  private readonly limited: ChannelData[];
  private readonly probes: DopplerChannels[];
  private readonly beats = new Beats();
  private readonly alarms = new Alarms();
  private readonly drops = new Poisson(Math.random);
  private readonly bubbles = new Poisson(Math.random);
  private readonly impacts: Impacts;
  private readonly surroundings: Surroundings;
  private late: ReadonlyMap<string, Priority> = new Map();
  private lastS: number | null = null;

  constructor(bundle: Bundle) {
    this.channels = new Channels(bundle.channels);
    this.pulse = bundle.bodies.find((b) => b.pulseChannel !== '')?.pulseChannel ?? '';
    this.pressure = pressureOfPulse(bundle.channels, this.pulse);
    const inflows = bundle.drawables.map((d) => inflowOf(d.declared, bundle.materials));
    this.inflows = [...new Set(inflows)].filter((id) => id !== '');
    this.limited = bundle.channels.filter(hasLimits);
    this.probes = dopplers(bundle.channels);
    this.impacts = new Impacts(bundle);
    this.surroundings = new Surroundings(bundle);
  }

  event({ kind, sim_time_s: timeS, hand }: Heard, desk: Desk, arrivedMs: number): void {
    if (kind === 'reset') this.restart(desk);
    const sound = soundOf(kind);
    if (!sound) return;
    const parting = partingOf({ kind, hand });
    if (parting) desk.part(parting, arrivedMs);
    if (sound.clip) desk.click(sound.clip, arrivedMs);
    if (sound.alarm && this.alarms.event(sound.alarm, timeS)) this.warn(sound.alarm, timeS, desk, arrivedMs);
  }

  frame(frame: RenderFrame, desk: Desk, arrivedMs: number): void {
    const timeS = frame.sim_time_s;
    const pastS = this.lastS === null ? 0 : timeS - this.lastS;
    if (pastS < 0) this.restart(desk);
    this.lastS = timeS;
    if (frame.paused || pastS <= 0) {
      if (frame.paused) desk.silence();
      return;
    }
    if (this.readChannels(frame)) this.hearChannels(timeS, Math.min(longestS, pastS), desk, arrivedMs);
    const drawn = this.surroundings.drawn(frame);
    const bubbles = drawn === 'fluid' ? this.bubbles.count(bubbleRate, Math.min(longestS, pastS)) : 0;
    desk.suck(drawn, bubbles, arrivedMs);
    for (const { what, strength } of this.impacts.read(frame)) desk.hit(what, strength, arrivedMs);
  }

  /** Clocks of the exercise: those that run past their limit. */
  clocks(timers: readonly TimerView[]): void {
    const over = timers.filter((t) => t.running && t.limitS > 0 && t.elapsedS > t.limitS);
    this.late = new Map(over.map((t) => [`clock ${t.id}`, clockAlarm]));
  }

  private hearChannels(timeS: number, pastS: number, desk: Desk, arrivedMs: number): void {
    const beat = this.beats.read(this.channels.value(this.pulse), this.channels.value(this.pressure));
    if (beat) desk.beat(beat.pressurePa, arrivedMs);
    const rate = this.inflows.reduce((sum, id) => sum + Math.max(0, this.channels.value(id) ?? 0), 0);
    desk.bleed(rate, this.drops.count(dropsPerSecond(rate), pastS), arrivedMs);
    desk.insonate(this.insonated(), arrivedMs);
    const present = new Map(this.late);
    for (const c of this.limited)
      if (level(c, this.channels.value(c)) === 'too_much') present.set(`channel ${c.id}`, channelAlarm);
    const due = this.alarms.watch(present, timeS);
    if (due) this.warn(due, timeS, desk, arrivedMs);
  }

  /** The blood under the probe that is in a hand; of two, that with the larger shift. */
  private insonated(): Flow | null {
    let most: Flow | null = null;
    for (const { shift, depth, mixed } of this.probes) {
      const shiftHz = this.channels.value(shift) ?? 0;
      if (Math.abs(shiftHz) <= Math.abs(most?.shiftHz ?? 0)) continue;
      most = { shiftHz, depthM: this.channels.value(depth), mixed: (this.channels.value(mixed) ?? 0) > 0 };
    }
    return most;
  }

  private warn(priority: Priority, timeS: number, desk: Desk, arrivedMs: number): void {
    const lengthS = desk.warn(priority, arrivedMs);
    if (lengthS > 0) this.alarms.began(priority, timeS, lengthS);
  }

  /** False: the numbers do not fit what is declared; the page says so elsewhere. */
  private readChannels(frame: RenderFrame): boolean {
    try {
      this.channels.read(frame.channel);
      return true;
    } catch (e) {
      if (!(e instanceof DataError)) throw e;
      return false;
    }
  }

  private restart(desk: Desk): void {
    desk.silence();
    this.alarms.reset();
    this.impacts.forget();
    this.late = new Map();
    this.lastS = null;
  }
}
