// SPDX-License-Identifier: GPL-3.0-or-later
// The sound of a recording while it runs at its own speed. Slower and faster it is silent, since sounds that are drawn
// out or crowded tell nothing.
import type { Bundle } from '../bundle_types';
import { el } from '../hud/dom';
import { SoundPanel } from '../hud/sound_panel';
import type { SoundReport } from '../sound/meter';
import { Sound } from '../sound/sound';
import type { ReplayClock } from './clock';
import type { SessionView } from './session_view';
import type { Happening } from './timeline';

/** Later ones are of a jump. */
const longestS = 0.5;

export class ReplaySound {
  readonly root: HTMLElement;
  private readonly sound: Sound;
  private readonly panel: SoundPanel;
  private bundle: Bundle | null = null;
  private lastS = Infinity;

  constructor(report: SoundReport) {
    this.panel = new SoundPanel({ sound: (change) => this.sound.choose(change) }, '');
    this.sound = new Sound(report, () => this.show());
    this.root = el('section', { class: 'panel' }, this.panel.root);
    this.show();
  }

  /** A picture was drawn. */
  picture({ world, moment, reading }: SessionView, clock: ReplayClock, events: readonly Happening[]): void {
    const { timeS } = clock;
    const fromS = this.lastS;
    const plays = clock.playing && clock.speed === 1 && timeS >= fromS && timeS - fromS < longestS;
    this.lastS = timeS;
    if (world && world.bundle !== this.bundle) this.sound.begin((this.bundle = world.bundle));
    if (!plays || !moment) {
      this.sound.lost();
      return;
    }
    const now = performance.now();
    const { frame } = moment.before;
    for (const { kind, hand, timeS: atS } of events)
      if (atS > fromS && atS <= timeS) this.sound.event({ kind, hand, sim_time_s: frame.sim_time_s }, now);
    this.sound.clocks(reading.state?.timers ?? []);
    this.sound.frame(frame, now);
  }

  private show(): void {
    this.panel.show(this.sound.settings, this.sound.waits);
  }
}
