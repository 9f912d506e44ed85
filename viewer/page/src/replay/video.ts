// SPDX-License-Identifier: GPL-3.0-or-later
// A video (WebM) of a stretch of the recording, taken from the canvas while the stretch is played once.
import type { ReplayClock, Stretch } from './clock';
import { text } from '../languages/text';

const framesPerSecond = 30;
const bitsPerSecond = 6_000_000;
const flushMs = 500;
const patienceMs = 10_000;

/** The first container and codec that this browser can write; '': its own choice. */
function videoType(): string {
  const types = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm'];
  return types.find((t) => MediaRecorder.isTypeSupported(t)) ?? '';
}

export class VideoRecorder {
  private recorder: MediaRecorder | null = null;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly clock: ReplayClock,
  ) {}

  get running(): boolean {
    return this.recorder !== null;
  }

  /** Plays the stretch at the present speed, and gives the video at its end. */
  async record({ fromS, toS }: Stretch): Promise<Blob> {
    const stream = this.canvas.captureStream(framesPerSecond);
    const recorder = new MediaRecorder(stream, { mimeType: videoType(), videoBitsPerSecond: bitsPerSecond });
    const parts: Blob[] = [];
    recorder.ondataavailable = (e) => parts.push(e.data);
    const stopped = new Promise<void>((resolve) => (recorder.onstop = () => resolve()));
    this.clock.seek(fromS);
    this.clock.playing = true;
    this.recorder = recorder;
    recorder.start(flushMs);
    await new Promise<void>((resolve) => {
      const watch = () => {
        if (this.clock.playing && this.clock.timeS < toS) requestAnimationFrame(watch);
        else resolve();
      };
      watch();
    });
    this.clock.playing = false;
    // On a slow machine the stretch may have passed before a picture of it was encoded.
    const size = () => parts.reduce((n, p) => n + p.size, 0);
    for (let k = 0; k < patienceMs / flushMs && size() === 0; k++) await new Promise((r) => setTimeout(r, flushMs));
    recorder.stop();
    await stopped;
    this.recorder = null;
    for (const track of stream.getTracks()) track.stop();
    if (size() === 0) throw new Error(text('this browser encoded no picture'));
    return new Blob(parts, { type: 'video/webm' });
  }
}
