// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the sounds and measures how late each is: from the arrival of the message that it answers to its start on the
// clock of the audio. What the sound card adds is the same for all and told apart.
import type { Voice } from './table';

/** A sound should begin within this after its message, ms. */
const limitMs = 20;

export interface SoundReport {
  /** A context plays. */
  running: boolean;
  /** Of all sounds that were begun. */
  played: number;
  /** Sounds that came too thick and were left out. */
  left_out: number;
  by_voice: Partial<Record<Voice, number>>;
  /** From the message's arrival to the sound's start: of the last one, and the longest. */
  latest_ms: number;
  latest_ms_max: number;
  /** Sounds that began more than 20 ms after the message. */
  late: number;
  /** Of the sound card and the browser's buffer. */
  device_ms: number;
}

export const freshReport = (): SoundReport => ({
  ...{ running: false, played: 0, left_out: 0, by_voice: {}, latest_ms: 0, latest_ms_max: 0, late: 0, device_ms: 0 },
});

/** arrivedMs: of the page's clock. aheadS: how far the start lies in the future of the audio's clock. */
export function count(report: SoundReport, voice: Voice, arrivedMs: number, aheadS: number): void {
  report.played++;
  report.by_voice[voice] = (report.by_voice[voice] ?? 0) + 1;
  report.latest_ms = performance.now() - arrivedMs + 1000 * aheadS;
  if (report.latest_ms > limitMs) report.late++;
  report.latest_ms_max = Math.max(report.latest_ms_max, report.latest_ms);
}
