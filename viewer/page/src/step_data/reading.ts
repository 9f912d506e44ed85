// SPDX-License-Identifier: GPL-3.0-or-later
// What the newest frame says beside its picture: the numbers of the channels and the state of the exercise.
import type { Bundle } from '../bundle_types';
import { type HudState, parseHud } from '../hud/state';
import type { RenderFrame } from '../lcm';
import { Channels } from './channels';
import { DataError } from './declarations';

export class Reading {
  channels = new Channels([]);
  /** What hud_json says; null before the first frame. */
  state: HudState | null = null;
  /** What is wrong with the frame's channels; '': nothing. */
  problem = '';
  private frame: RenderFrame | null = null;

  begin(bundle: Bundle): void {
    this.channels = new Channels(bundle.channels);
    this.state = null;
    this.frame = null;
    this.problem = '';
  }

  /** Once a frame; the same frame again costs nothing. */
  read(frame: RenderFrame | null): void {
    if (!frame || frame === this.frame) return;
    if (frame.hud_json !== this.frame?.hud_json) this.state = parseHud(frame.hud_json) ?? this.state;
    this.frame = frame;
    this.problem = '';
    try {
      this.channels.read(frame.channel);
    } catch (e) {
      if (!(e instanceof DataError)) throw e;
      this.problem = e.message;
    }
  }
}
