// SPDX-License-Identifier: GPL-3.0-or-later
// The sound of the page. Browsers let a page sound only after its user has done something there, so the audio begins
// with the first key or click after sound was switched on. It rests while the page is hidden.
import { browserStore } from '../browser_store';
import type { Bundle } from '../bundle_types';
import type { TimerView } from '../hud/state';
import type { RenderFrame } from '../lcm';
import { Desk } from './desk';
import { type Heard, Listener } from './listener';
import type { SoundReport } from './meter';
import { readSettings, type SoundSettings, writeSettings } from './settings';

const gestures = ['pointerdown', 'keydown', 'touchend'] as const;

export class Sound {
  settings: SoundSettings = readSettings(browserStore());
  private context: AudioContext | null = null;
  private desk: Desk | null = null;
  private listener: Listener | null = null;
  /** The scene. A listener to it is made when sound is on, since it takes a moment. */
  private scene: Bundle | null = null;

  /** changed: the settings, or whether the audio runs. */
  constructor(
    private readonly report: SoundReport,
    private readonly changed: () => void,
  ) {
    for (const g of gestures) window.addEventListener(g, () => this.gesture(), { capture: true, passive: true });
    document.addEventListener('visibilitychange', () => this.follow());
  }

  begin(bundle: Bundle): void {
    this.desk?.silence();
    this.listener = null;
    this.scene = bundle;
    if (this.settings.on) this.listen();
  }

  event(m: Heard, arrivedMs: number): void {
    if (this.sounds) this.listener?.event(m, this.desk!, arrivedMs);
  }

  frame(m: RenderFrame, arrivedMs: number): void {
    if (this.sounds) this.listener?.frame(m, this.desk!, arrivedMs);
  }

  /** A hint is given. */
  hint(nowMs: number): void {
    if (this.sounds) this.desk!.hint(nowMs);
  }

  clocks(timers: readonly TimerView[]): void {
    this.listener?.clocks(timers);
  }

  /** The engine or the way to it is gone. */
  lost(): void {
    this.desk?.silence();
  }

  /** Keeps a choice of the user and follows it. */
  choose(change: Partial<SoundSettings>): void {
    this.settings = { ...this.settings, ...change };
    writeSettings(browserStore(), this.settings);
    this.desk?.set(this.settings);
    this.follow();
    this.gesture();
    this.changed();
  }

  /** It is on, and begins with the next key or click. */
  get waits(): boolean {
    return this.settings.on && !this.report.running;
  }

  private get sounds(): boolean {
    return this.wanted && this.desk !== null && this.context?.state === 'running';
  }

  private listen(): void {
    if (this.scene) this.listener ??= new Listener(this.scene);
  }

  private get wanted(): boolean {
    return this.settings.on && !document.hidden;
  }

  /** A user has just done something here, so audio may begin. */
  private gesture(): void {
    if (!this.wanted || this.context?.state === 'running') return;
    this.context ??= this.open();
    this.listen();
    this.follow();
  }

  private open(): AudioContext {
    const context = new AudioContext({ latencyHint: 'interactive' });
    context.onstatechange = () => this.tell();
    this.desk = new Desk(context, this.report);
    this.desk.set(this.settings);
    return context;
  }

  /** Lets the audio run or rest. */
  private follow(): void {
    if (!this.context) return;
    if (!this.wanted) this.desk?.silence();
    const done = this.wanted ? this.context.resume() : this.context.suspend();
    // A browser that forbids it says so in the state of the context.
    done.then(
      () => this.tell(),
      () => this.tell(),
    );
  }

  private tell(): void {
    if (this.context) {
      this.report.running = this.context.state === 'running';
    }
    this.changed();
  }
}
