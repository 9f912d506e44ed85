// SPDX-License-Identifier: GPL-3.0-or-later
// Picture quality levels, and the watch that steps down when the page falls below 40 frames/s and up again when it is idle.
import type { LensSettings } from './lens_material';
import type { QualityName } from './options';

export interface Level {
  name: QualityName;
  /** Device pixels per CSS pixel, at most. */
  pixel_ratio: number;
  shadow_size: number;
  lens: LensSettings;
}

export const levels: Level[] = [
  { name: 'low', pixel_ratio: 0.6, shadow_size: 0, lens: { occlusion: false, depth_of_field: false, samples: 0 } },
  { name: 'medium', pixel_ratio: 0.85, shadow_size: 1024, lens: { occlusion: false, depth_of_field: false, samples: 2 } },
  { name: 'high', pixel_ratio: 1.25, shadow_size: 2048, lens: { occlusion: true, depth_of_field: false, samples: 4 } },
  { name: 'ultra', pixel_ratio: 2, shadow_size: 4096, lens: { occlusion: true, depth_of_field: true, samples: 4 } },
];

const low_fps = 40;
const good_fps = 57;

/** Decides from measured frame rates; pure, so that it can be tested. */
export class QualityWatch {
  level: number;
  private good_s = 0;
  private bad_s = 0;
  private raise_after_s = 12;

  constructor(private readonly fixed: QualityName | null, start: QualityName = 'high') {
    this.level = levels.findIndex((l) => l.name === (fixed ?? start));
  }

  get automatic(): boolean { return this.fixed === null; }

  /** Once a second or so; returns true when the level changed. */
  observe(fps: number, seconds: number): boolean {
    if (this.fixed !== null) return false;
    this.bad_s = fps < low_fps ? this.bad_s + seconds : 0;
    this.good_s = fps >= good_fps ? this.good_s + seconds : 0;
    if (this.bad_s >= 2 && this.level > 0) {
      this.level--;
      this.bad_s = this.good_s = 0;
      // What had to be lowered is not raised again at once: no swinging.
      this.raise_after_s *= 3;
      return true;
    }
    // Depth of field is a choice, not a default: automatic stops below it.
    if (this.good_s >= this.raise_after_s && this.level < levels.length - 2) {
      this.level++;
      this.good_s = 0;
      return true;
    }
    return false;
  }
}
