// SPDX-License-Identifier: GPL-3.0-or-later
// How the field is looked at: one eye or two, in a headset, in infrared; kept in one place for keys, buttons and the address line.
import type { Headset } from './headset';
import { clamp_angle, type StereoMode } from './stereo';

export interface ViewOutputs {
  infrared(on: boolean): void;
  stereo(mode: StereoMode, angle_deg: number, headset: boolean, presenting: boolean): void;
  refuse(why: string): void;
}

export class ViewModes {
  stereo: StereoMode;
  angle_deg: number;
  infrared: boolean;
  private headset_found = false;

  constructor(options: { stereo: StereoMode; angle_deg: number; infrared: boolean }, private readonly headset: Headset, private readonly out: ViewOutputs) {
    this.stereo = options.stereo;
    this.angle_deg = options.angle_deg;
    this.infrared = options.infrared;
    void headset.supported.then((yes) => { this.headset_found = yes; this.tell(); });
  }

  tell(): void {
    this.out.infrared(this.infrared);
    this.out.stereo(this.stereo, this.angle_deg, this.headset_found, this.headset.presenting);
  }

  set_infrared(on: boolean): void { this.infrared = on; this.tell(); }

  set_angle(deg: number): void { this.angle_deg = clamp_angle(deg); this.tell(); }

  /** `clicked`: a headset lets a page in only from a click. */
  set_stereo(mode: StereoMode, clicked = false): void {
    if (mode !== 'xr' && this.headset.presenting) void this.headset.leave();
    this.stereo = mode;
    this.tell();
    if (mode !== 'xr' || !clicked || this.headset.presenting) return;
    this.headset.enter().then(() => this.tell(), (e: unknown) => {
      this.out.refuse(`The headset is not ready: ${e instanceof Error ? e.message : String(e)}`);
      this.set_stereo('off');
    });
  }

  next_stereo(): void { this.set_stereo(this.stereo === 'off' ? 'sbs' : this.stereo === 'sbs' ? 'anaglyph' : 'off'); }
}
