// SPDX-License-Identifier: GPL-3.0-or-later
// The recorded pictures by time. Each chunk begins with a complete one, so any moment needs one chunk, or two at the
// border.
import { type RenderFrame, render_frame_t } from '../lcm';
import type { Container, Message } from './container';
import type { Chunk } from './container_index';
import { GeometryDecoder } from './geometry';

const topics = { frame: 'FRAME', geometry: 'GEOMETRY' };
const keptChunks = 6;

export interface Picture {
  timeS: number;
  frame: RenderFrame;
}

/** The pictures around a time; share: 0 at `before`, 1 at `after`. */
export interface Moment {
  before: Picture;
  after: Picture;
  share: number;
}

/** The pictures of one chunk, decoded up to the one that was wanted. */
class ChunkPictures {
  private readonly pairs: { frame: Message; geometry: Message }[] = [];
  private readonly done: Picture[] = [];
  private readonly decoder: GeometryDecoder;

  constructor(messages: readonly Message[], frameChannel: number, geometryChannel: number, unit: number) {
    this.decoder = new GeometryDecoder(unit);
    let frame: Message | null = null;
    for (const m of messages) {
      if (m.channel === frameChannel) frame = m;
      else if (m.channel === geometryChannel && frame) {
        this.pairs.push({ frame, geometry: m });
        frame = null;
      }
    }
  }

  get length(): number {
    return this.pairs.length;
  }
  timeS(k: number): number {
    return this.pairs[k]!.frame.timeS;
  }

  /** Null: it, or one that it needs, is damaged. */
  at(k: number): Picture | null {
    try {
      while (this.done.length <= k) {
        const { frame, geometry } = this.pairs[this.done.length]!;
        const decoded = render_frame_t.decode(frame.data);
        this.done.push({ timeS: frame.timeS, frame: { ...decoded, ...this.decoder.decode(geometry.data) } });
      }
    } catch {
      this.pairs.length = this.done.length;
    }
    return this.done[k] ?? null;
  }
}

export class Pictures {
  private readonly chunks: readonly Chunk[];
  private readonly kept = new Map<number, Promise<ChunkPictures>>();
  private readonly unit: number;

  constructor(private readonly container: Container) {
    this.chunks = container.chunksOf(topics.frame);
    this.unit = container.unitOf(topics.geometry);
  }

  /** Null: there is no picture that can be read. */
  async at(timeS: number): Promise<Moment | null> {
    if (this.chunks.length === 0) return null;
    let n = this.chunks.findLastIndex((c) => c.firstS <= timeS);
    n = Math.max(0, n);
    // A damaged chunk shows the last picture before it.
    for (let k = n; k >= 0; k--) {
      const moment = await this.within(k, timeS);
      if (moment) return moment;
    }
    for (let k = n + 1; k < this.chunks.length; k++) {
      const first = (await this.chunk(k)).at(0);
      if (first) return { before: first, after: first, share: 0 };
    }
    return null;
  }

  private async within(n: number, timeS: number): Promise<Moment | null> {
    const pictures = await this.chunk(n);
    let k = 0;
    while (k + 1 < pictures.length && pictures.timeS(k + 1) <= timeS) k++;
    const before = pictures.at(k);
    if (!before) return null;
    const after = pictures.at(k + 1 < pictures.length ? k + 1 : k) ?? before;
    const next = after !== before || n + 1 >= this.chunks.length ? after : ((await this.chunk(n + 1)).at(0) ?? before);
    // Time began again in between: nothing moves from the one to the other.
    if (next.frame.sim_time_s < before.frame.sim_time_s) return { before, after: before, share: 0 };
    const gap = next.timeS - before.timeS;
    return { before, after: next, share: gap > 0 ? Math.min(1, Math.max(0, (timeS - before.timeS) / gap)) : 0 };
  }

  private chunk(n: number): Promise<ChunkPictures> {
    const found = this.kept.get(n) ?? this.read(n);
    this.kept.delete(n);
    this.kept.set(n, found);
    if (this.kept.size > keptChunks) this.kept.delete(this.kept.keys().next().value!);
    return found;
  }

  private async read(n: number): Promise<ChunkPictures> {
    const messages = await this.container.unpack(this.chunks[n]!);
    const channel = (topic: string) => this.container.channels.get(topic) ?? -1;
    return new ChunkPictures(messages, channel(topics.frame), channel(topics.geometry), this.unit);
  }
}
