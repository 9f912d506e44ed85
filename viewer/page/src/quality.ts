// SPDX-License-Identifier: GPL-3.0-or-later
// Picture quality levels, and the watch that steps down when the page falls below 40 frames/s and up again when it is
// idle.
import type { LensSettings } from './lens_material';
import type { QualityName } from './options';

export interface Level {
  name: QualityName;
  /** Device pixels per CSS pixel, at most. */
  pixelRatio: number;
  shadowSize: number;
  /** Simpler materials, and shadows of tools alone. */
  cheap: boolean;
  /** Between the drawn surfaces and those with all triangles, m, as an estimate; 0: all triangles. */
  coarseM: number;
  lens: LensSettings;
}

const plain: LensSettings = { occlusion: false, depthOfField: false, samples: 0 };

/** In the order of `qualityNames`. `draft` is for pictures that are drawn without a graphics card. */
export const levels: Level[] = [
  { name: 'draft', pixelRatio: 0.3, shadowSize: 512, cheap: true, coarseM: 6e-5, lens: plain },
  { name: 'low', pixelRatio: 0.6, shadowSize: 512, cheap: true, coarseM: 6e-5, lens: plain },
  { name: 'medium', pixelRatio: 0.85, shadowSize: 1024, cheap: false, coarseM: 0, lens: { ...plain, samples: 2 } },
  {
    name: 'high',
    pixelRatio: 1.25,
    shadowSize: 2048,
    cheap: false,
    coarseM: 0,
    lens: { ...plain, occlusion: true, samples: 4 },
  },
  {
    name: 'ultra',
    pixelRatio: 2,
    shadowSize: 4096,
    cheap: false,
    coarseM: 0,
    lens: { occlusion: true, depthOfField: true, samples: 4 },
  },
];

const lowFps = 40;
const goodFps = 57;

/** Decides from measured frame rates; pure, so that it can be tested. */
export class QualityWatch {
  level: number;
  private goodS = 0;
  private badS = 0;
  private raiseAfterS = 12;

  constructor(
    private readonly fixed: QualityName | null,
    start: QualityName = 'high',
  ) {
    this.level = levels.findIndex((l) => l.name === (fixed ?? start));
  }

  get automatic(): boolean {
    return this.fixed === null;
  }

  /** Once a second or so; returns true when the level changed. */
  observe(fps: number, seconds: number): boolean {
    if (this.fixed !== null) return false;
    this.badS = fps < lowFps ? this.badS + seconds : 0;
    this.goodS = fps >= goodFps ? this.goodS + seconds : 0;
    if (this.badS >= 2 && this.level > 0) {
      this.level--;
      this.badS = this.goodS = 0;
      // What had to be lowered is not raised again at once: no swinging.
      this.raiseAfterS *= 3;
      return true;
    }
    // Depth of field is a choice, not a default: automatic stops below it.
    if (this.goodS >= this.raiseAfterS && this.level < levels.length - 2) {
      this.level++;
      this.goodS = 0;
      return true;
    }
    return false;
  }
}
