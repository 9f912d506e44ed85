// SPDX-License-Identifier: GPL-3.0-or-later
// The last two frames and the picture's place between them: shown one frame late, so motion is even whatever the network does.
import type { RenderFrame } from './lcm';

export class Playback {
  frames = 0;
  latest: RenderFrame | null = null;
  private previous: RenderFrame | null = null;
  private arrived_ms = 0;
  private period_ms = 1000 / 60;
  private scratch = new Map<number, Float32Array>();

  push(frame: RenderFrame, now_ms: number): void {
    if (this.latest && (frame.session !== this.latest.session || frame.sequence < this.latest.sequence)) this.clear();
    if (this.latest) {
      const gap = now_ms - this.arrived_ms;
      if (gap < 500) this.period_ms += 0.1 * (gap - this.period_ms);
    }
    this.previous = this.latest;
    this.latest = frame;
    this.arrived_ms = now_ms;
    this.frames++;
  }

  clear(): void {
    this.latest = this.previous = null;
    this.scratch.clear();
  }

  /** 0: the previous frame, 1: the newest. */
  blend(now_ms: number): number {
    return Math.max(0, Math.min(1, (now_ms - this.arrived_ms) / Math.max(1, this.period_ms)));
  }

  /** Blended node positions of a body, or null when the frame has none. The array is reused. */
  nodes(index: number, t: number): Float32Array | null {
    const b = this.latest?.body.find((x) => x.index === index)?.x_m;
    if (!b) return null;
    const a = this.previous?.body.find((x) => x.index === index)?.x_m;
    let out = this.scratch.get(index);
    if (!out || out.length !== b.length) this.scratch.set(index, (out = new Float32Array(b.length)));
    mix(a && a.length === b.length ? a : b, b, t, out);
    return out;
  }

  strand_ends(t: number): Float32Array {
    const b = this.latest?.strand_x_m ?? new Float32Array(0);
    const a = this.previous?.strand_x_m;
    let out = this.scratch.get(-1);
    if (!out || out.length !== b.length) this.scratch.set(-1, (out = new Float32Array(b.length)));
    mix(a && a.length === b.length ? a : b, b, t, out);
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
