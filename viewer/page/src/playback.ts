// SPDX-License-Identifier: GPL-3.0-or-later
// The last two frames and the picture's place between them: shown one frame late, so motion is even whatever the
// network does.
import type { RenderFrame } from './lcm';
import { checkDrawable, mixDrawable } from './step_data/drawable_data';
import type { DrawableData } from './step_data/declarations';

export class Playback {
  frames = 0;
  latest: RenderFrame | null = null;
  private previous: RenderFrame | null = null;
  private arrivedMs = 0;
  private periodMs = 1000 / 60;
  private scratch = new Map<string, Float32Array>();
  private checked = new Map<number, Float32Array>();
  private share: number | null = null;

  push(frame: RenderFrame, nowMs: number): void {
    if (this.latest && (frame.session !== this.latest.session || frame.sequence < this.latest.sequence)) this.clear();
    if (this.latest) {
      const gap = nowMs - this.arrivedMs;
      if (gap < 500) this.periodMs += 0.1 * (gap - this.periodMs);
    }
    this.previous = this.latest;
    this.latest = frame;
    this.arrivedMs = nowMs;
    this.frames++;
  }

  /** Shows these two frames, at this place between them, until the next call. */
  hold(previous: RenderFrame, latest: RenderFrame, share: number): void {
    if (this.latest !== latest) this.frames++;
    this.previous = previous;
    this.latest = latest;
    this.share = share;
  }

  clear(): void {
    this.latest = this.previous = null;
    this.scratch.clear();
    this.checked.clear();
  }

  /** 0: the previous frame, 1: the newest. */
  blend(nowMs: number): number {
    return this.share ?? Math.max(0, Math.min(1, (nowMs - this.arrivedMs) / Math.max(1, this.periodMs)));
  }

  /** Blended node positions of a body, or null when the frame has none. The array is reused. */
  nodes(index: number, t: number): Float32Array | null {
    const b = this.latest?.body.find((x) => x.index === index)?.x_m;
    if (!b) return null;
    const a = this.previous?.body.find((x) => x.index === index)?.x_m;
    let out = this.scratch.get(`b${index}`);
    if (!out || out.length !== b.length) this.scratch.set(`b${index}`, (out = new Float32Array(b.length)));
    mix(a && a.length === b.length ? a : b, b, t, out);
    return out;
  }

  /**
   * Blended numbers of a drawable, or null when the frame has none. Checks them; throws DataError. The array is
   * reused.
   */
  drawable(declared: DrawableData, t: number): Float32Array | null {
    const { index } = declared;
    const b = this.latest?.drawable.find((x) => x.index === index)?.data;
    if (!b) return null;
    if (this.checked.get(index) !== b) checkDrawable(declared, b);
    this.checked.set(index, b);
    const a = this.previous?.drawable.find((x) => x.index === index)?.data ?? null;
    const key = `d${index}`;
    let out = this.scratch.get(key);
    if (!out || out.length !== b.length) this.scratch.set(key, (out = new Float32Array(b.length)));
    mixDrawable(declared, a, b, t, out);
    return out;
  }

  tool(index: number): { a: RenderFrame['tool'][number]; b: RenderFrame['tool'][number] } | null {
    const b = this.latest?.tool.find((x) => x.index === index);
    if (!b) return null;
    return { a: this.previous?.tool.find((x) => x.index === index) ?? b, b };
  }
}

export function mix(a: Float32Array, b: Float32Array, t: number, out: Float32Array): void {
  for (let i = 0; i < b.length; i++) out[i] = a[i]! + (b[i]! - a[i]!) * t;
}
