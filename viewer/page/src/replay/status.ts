// SPDX-License-Identifier: GPL-3.0-or-later
// What a replay tells tests and screenshots about itself, as window.__replay.
import { freshReport, type SoundReport } from '../sound/meter';

export interface ReplayStatus {
  ready: boolean;
  /** From the page's start until there was a picture to move in, and until it was complete; 0: not yet. */
  open_ms: number;
  complete_ms: number;
  /** Jumps whose picture was drawn; from the last jump to its picture. */
  seeks: number;
  seek_ms: number;
  /** The longest time to find and decode one. */
  decode_max_ms: number;
  time_s: number;
  duration_s: number;
  pictures: number;
  video_bytes: number;
  /** Chunks of the file: those with the timeline, all that were unpacked to open it, and the most for one jump. */
  timeline_chunks: number;
  chunks_unpacked_to_open: number;
  seek_chunks_max: number;
  /** What was heard. */
  sound: SoundReport;
}

export const freshStatus = (): ReplayStatus => ({
  ready: false,
  open_ms: 0,
  complete_ms: 0,
  seeks: 0,
  seek_ms: 0,
  decode_max_ms: 0,
  time_s: 0,
  duration_s: 0,
  pictures: 0,
  video_bytes: 0,
  timeline_chunks: 0,
  chunks_unpacked_to_open: 0,
  seek_chunks_max: 0,
  sound: freshReport(),
});
