// SPDX-License-Identifier: GPL-3.0-or-later
// What the page tells tests and screenshots about itself, as window.__insula.
import { freshReport } from './sound/meter';

export const status = {
  ready: false,
  frames: 0,
  pictures: 0,
  fps: 0,
  session: '',
  quality: '',
  connected: false,
  frozen: false,
  refused: 0,
  error: '',
  /** What is wrong with the engine's data, one line each. */
  problems: [] as string[],
  /** Where the point that is moved with the mouse is on the page, px; null: there is none. */
  placing: null as [number, number] | null,
  build_ms: 0,
  taken: [false, false],
  active: 1,
  triangles: 0,
  /** Draw calls of the last picture, shadows included. */
  calls: 0,
  /** Of each hand's tip from the tissue; null: no cue. */
  tip_mm: [] as (number | null)[],
  /** Of the ruler: from the tip to the tissue, and between both tips; null: not shown, or too far. */
  ruler_mm: null as number | null,
  apart_mm: null as number | null,
  /** Tools of another run over the field. */
  ghost_tools: 0,
  /** Pictures that were read back for an overview. */
  thumbnails: 0,
  /** How it stands with talking by voice, and the sound that came from the other side (sum of its energy). */
  voice: { state: 'off', energy: 0 },
  /** Strokes over the picture; when the last part of one was sent or heard here, ms since 1970. */
  strokes: 0,
  stroke_ms: 0,
  stereo: 'off',
  infrared: false,
  presenting: false,
  graphics_lost: false,
  /** What was heard, and how late. */
  sound: freshReport(),
  /** By hand: whether its buttons are on. */
  buttons: [
    [false, false],
    [false, false],
  ],
  /** Hint that is shown; '': none. */
  cue: '',
  /** Step of the tour that is shown; '': none. */
  tour: '',
  /** Of the active hand's target: which, and how far; null: none is shown. */
  target: null as { at: number; of: number; distance_m: number; angle_rad: number } | null,
};
(window as unknown as { __insula: typeof status }).__insula = status;

/** Of one picture. */
export function tellPicture(picture: {
  presenting: boolean;
  stage: { triangles: number; calls: number };
  graphics: { lost: boolean };
  frames: number;
  refused: number;
}): void {
  status.presenting = picture.presenting;
  status.triangles = picture.stage.triangles;
  status.calls = picture.stage.calls;
  status.graphics_lost = picture.graphics.lost;
  status.frames = picture.frames;
  status.refused = picture.refused;
}
