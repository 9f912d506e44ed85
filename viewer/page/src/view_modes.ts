// SPDX-License-Identifier: GPL-3.0-or-later
// How the field is looked at: one eye or two, in a headset, in infrared; kept in one place for keys, buttons and the
// address line.
import { type RulerMode, rulerModes } from './depth_ruler';
import type { Headset } from './headset';
import { clampAngle, type StereoMode } from './stereo_modes';
import { text } from './languages/text';

export interface ViewOutputs {
  infrared(on: boolean): void;
  stereo(mode: StereoMode, angleDeg: number, headset: boolean, presenting: boolean): void;
  ruler(mode: RulerMode): void;
  refuse(why: string): void;
}

export class ViewModes {
  stereo: StereoMode;
  angleDeg: number;
  infrared: boolean;
  /** Whether the depth of the tips is drawn. */
  depth: boolean;
  /** The scale from the tip of the active hand to the tissue. */
  ruler: RulerMode = 'off';
  private headsetFound = false;

  constructor(
    options: { stereo: StereoMode; angleDeg: number; infrared: boolean; depth: boolean },
    private readonly headset: Headset,
    private readonly out: ViewOutputs,
  ) {
    this.stereo = options.stereo;
    this.angleDeg = options.angleDeg;
    this.infrared = options.infrared;
    this.depth = options.depth;
    void headset.supported.then((yes) => {
      this.headsetFound = yes;
      this.tell();
    });
  }

  tell(): void {
    this.out.infrared(this.infrared);
    this.out.stereo(this.stereo, this.angleDeg, this.headsetFound, this.headset.presenting);
    this.out.ruler(this.ruler);
  }

  setInfrared(on: boolean): void {
    this.infrared = on;
    this.tell();
  }

  toggleDepth(): void {
    this.depth = !this.depth;
  }

  nextRuler(): void {
    this.ruler = rulerModes[(rulerModes.indexOf(this.ruler) + 1) % rulerModes.length]!;
    this.tell();
  }

  setAngle(deg: number): void {
    this.angleDeg = clampAngle(deg);
    this.tell();
  }

  /** `clicked`: a headset lets a page in only from a click. */
  setStereo(mode: StereoMode, clicked = false): void {
    if (mode !== 'xr' && this.headset.presenting) void this.headset.leave();
    this.stereo = mode;
    this.tell();
    if (mode !== 'xr' || !clicked || this.headset.presenting) return;
    this.headset.enter().then(
      () => this.tell(),
      (e: unknown) => {
        this.out.refuse(text('The headset is not ready: {why}', { why: e instanceof Error ? e.message : String(e) }));
        this.setStereo('off');
      },
    );
  }

  nextStereo(): void {
    this.setStereo(this.stereo === 'off' ? 'sbs' : this.stereo === 'sbs' ? 'anaglyph' : 'off');
  }
}
