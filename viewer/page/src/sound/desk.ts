// SPDX-License-Identifier: GPL-3.0-or-later
// The voices of one audio context, each within its limit of sounds. Sounds begin at once: nothing is planned ahead.
import { count, type SoundReport } from './meter';
import { Mixer, type Place } from './mixer';
import { RateLimit } from './rate_limit';
import type { SoundSettings } from './settings';
import { type ClipSound, type Parting, type Priority, type Voice, voices } from './table';
import { AlarmVoice } from './voices/alarm';
import { BleedingVoice } from './voices/bleeding';
import { click } from './voices/clip';
import { hit, type Hit } from './voices/contact';
import { DopplerVoice, type Flow, timbreOf } from './voices/doppler';
import { beep } from './voices/heart';
import { hint } from './voices/hint';
import { part } from './voices/strand';
import { type Drawn, SuctionVoice } from './voices/suction';

export class Desk {
  private readonly mixer: Mixer;
  private readonly limits: Record<Voice, RateLimit>;
  private readonly suction: SuctionVoice;
  private readonly bleeding: BleedingVoice;
  private readonly alarm: AlarmVoice;
  private readonly doppler: DopplerVoice;

  constructor(
    private readonly context: AudioContext,
    private readonly report: SoundReport,
  ) {
    this.mixer = new Mixer(context);
    const limits = Object.entries(voices).map(([v, { most, withinS }]) => [v, new RateLimit(most, withinS)]);
    this.limits = Object.fromEntries(limits) as Record<Voice, RateLimit>;
    this.suction = new SuctionVoice(this.place('suction'));
    this.bleeding = new BleedingVoice(this.place('drop'));
    this.alarm = new AlarmVoice(this.place('alarm'));
    this.doppler = new DopplerVoice(this.place('doppler'));
  }

  set({ volume, groups }: SoundSettings): void {
    this.mixer.set(volume, groups);
  }

  beat(pressurePa: number | null, arrivedMs: number): void {
    this.strike('heart', arrivedMs, (at) => beep(this.place('heart'), at, pressurePa));
  }

  part(how: Parting, arrivedMs: number): void {
    this.strike('strand', arrivedMs, (at) => part(this.place('strand'), at, how, vary()));
  }

  click(how: ClipSound, arrivedMs: number): void {
    this.strike('clip', arrivedMs, (at) => click(this.place('clip'), at, how));
  }

  hit(what: Hit, strength: number, arrivedMs: number): void {
    this.strike('contact', arrivedMs, (at) => hit(this.place('contact'), at, what, strength, vary()));
  }

  /** Fluid that comes in at this rate, m3/s, and so many drops now. */
  bleed(rate: number, drops: number, arrivedMs: number): void {
    this.bleeding.play(rate, this.context.currentTime);
    for (let k = 0; k < drops; k++) this.strike('drop', arrivedMs, (at) => this.bleeding.drop(at, Math.random()));
  }

  /** What is drawn, and so many bubbles in it now; null: nothing. */
  suck(drawn: Drawn | null, bubbles: number, arrivedMs: number): void {
    const now = this.context.currentTime;
    if (!drawn) this.suction.stop(now);
    else if (this.suction.on) this.suction.play(drawn, now);
    else this.strike('suction', arrivedMs, (at) => this.suction.play(drawn, at));
    for (let k = 0; k < bubbles; k++) this.strike('suction', arrivedMs, (at) => this.suction.bubble(at, Math.random()));
  }

  /** The blood that a Doppler probe hears; null: none. */
  insonate(flow: Flow | null, arrivedMs: number): void {
    const now = this.context.currentTime;
    if (!flow || !timbreOf(flow)) this.doppler.stop(now);
    else if (this.doppler.on) this.doppler.play(flow, now);
    else this.strike('doppler', arrivedMs, (at) => this.doppler.play(flow, at));
  }

  /** Its length, s; 0: it is not heard. */
  warn(priority: Priority, arrivedMs: number): number {
    let length = 0;
    this.strike('alarm', arrivedMs, (at) => (length = this.alarm.sound(priority, at)));
    return length;
  }

  hint(arrivedMs: number): void {
    this.strike('hint', arrivedMs, (at) => hint(this.place('hint'), at));
  }

  /** What lasts ends now. */
  silence(): void {
    const now = this.context.currentTime;
    this.suction.stop(now);
    this.bleeding.stop(now);
    this.alarm.stop(now);
    this.doppler.stop(now);
  }

  private place(voice: Voice): Place {
    return this.mixer.place(voices[voice].group);
  }

  private strike(voice: Voice, arrivedMs: number, begin: (at: number) => void): void {
    const now = this.context.currentTime;
    if (!this.limits[voice].allows(now)) {
      this.report.left_out++;
      return;
    }
    begin(now);
    count(this.report, voice, arrivedMs, now, this.context);
  }
}

const vary = (): number => 2 * Math.random() - 1;
