// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the sounds and measures how late each is. A sound has three moments after the arrival of its message: it is
// handed to the audio, the audio's own thread begins it with its next block, and it leaves the loudspeaker. The last
// two are those of the audio's clock, which the browser relates to the page's (AudioContext.getOutputTimestamp).
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
  /** From the message's arrival until the audio begins the sound: of the last one, and the longest. */
  latest_ms: number;
  latest_ms_max: number;
  /** From there to the loudspeaker: of the last one. Of the sound card and the browser's buffers. */
  device_ms: number;
  /** Sounds that the audio began more than 20 ms after the message. */
  late: number;
}

export const freshReport = (): SoundReport => ({
  ...{ running: false, played: 0, left_out: 0, by_voice: {}, latest_ms: 0, latest_ms_max: 0, late: 0, device_ms: 0 },
});

/** What relates the audio's clock to the page's. */
export type Clock = Pick<AudioContext, 'baseLatency' | 'outputLatency' | 'currentTime' | 'getOutputTimestamp'>;

/** Of the output, s: some browsers do not know it. */
const outputS = (clock: Clock): number => clock.outputLatency || 0;

/** When the audio begins what it was given for its time `at`, on the page's clock, ms; now: that of the page. */
export function begunMs(clock: Clock, at: number, now: number): number {
  const { contextTime = 0, performanceTime = 0 } = clock.getOutputTimestamp();
  // Before the first output there is no relation; the next block is at most a buffer away.
  if (!(contextTime > 0)) return now + 1000 * clock.baseLatency;
  const heard = performanceTime + 1000 * (at - contextTime);
  return Math.max(now, heard - 1000 * outputS(clock));
}

/** arrivedMs: of the page's clock. at: when it begins on the audio's clock, s. */
export function count(report: SoundReport, voice: Voice, arrivedMs: number, at: number, clock: Clock): void {
  report.played++;
  report.by_voice[voice] = (report.by_voice[voice] ?? 0) + 1;
  report.latest_ms = begunMs(clock, at, performance.now()) - arrivedMs;
  report.device_ms = 1000 * outputS(clock);
  if (report.latest_ms > limitMs) report.late++;
  report.latest_ms_max = Math.max(report.latest_ms_max, report.latest_ms);
}
