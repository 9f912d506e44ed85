// SPDX-License-Identifier: GPL-3.0-or-later
// Reads an MCAP file where it lies: whole, without an end, or damaged. A chunk is read and unpacked when one of its
// messages is wanted, and checked against its checksum.
import { decompress } from 'fzstd';
import { BlockSource, type ByteSource } from './byte_source';
import { type Chunk, type ContainerIndex, indexOf } from './container_index';
import { Bytes, ContainerError, crc32, messageHead, mostChunkBytes, op, recordsOf } from './mcap_records';
import { fixed } from '../languages/numbers';
import { text } from '../languages/text';

/** Chunks that lie so close are read together, up to so many bytes. */
const gapBytes = 256 << 10;
const togetherBytes = 4 << 20;
const mostDamageLines = 100;

export interface Message {
  channel: number;
  timeS: number;
  data: Uint8Array;
}

export interface TopicMessage extends Message {
  topic: string;
}

export class Container {
  /** How many chunks were unpacked until now. */
  unpackedChunks = 0;

  private constructor(
    private readonly source: ByteSource,
    private readonly index: ContainerIndex,
  ) {}

  /** Throws ContainerError when it is no MCAP file. */
  static async open(file: ByteSource): Promise<Container> {
    const source = new BlockSource(file);
    return new Container(source, await indexOf(source));
  }

  get channels(): ReadonlyMap<string, number> {
    return this.index.channels;
  }
  get metadata(): ReadonlyMap<string, ReadonlyMap<string, string>> {
    return this.index.metadata;
  }
  get chunks(): readonly Chunk[] {
    return this.index.chunks;
  }
  /** The file was ended properly. */
  get ended(): boolean {
    return this.index.ended;
  }
  /** What could not be read, one line each. */
  get damage(): readonly string[] {
    return this.index.damage;
  }

  /** What whole numbers of a topic are multiples of; 1 if it does not say. */
  unitOf(topic: string): number {
    return Number(this.index.said.get(topic)?.get('unit') ?? 1) || 1;
  }

  has(attachment: string): boolean {
    return this.index.attachments.has(attachment);
  }

  /** Throws ContainerError if there is none of that name, or it is damaged. */
  async attachment(name: string): Promise<Uint8Array> {
    const place = this.index.attachments.get(name);
    if (!place) throw new ContainerError(text('{name} is missing in the recording', { name }));
    const r = new Bytes(await this.source.read(place.at, place.length));
    r.take(16);
    r.text();
    r.text();
    return r.take(r.u64());
  }

  /** Chunks with messages of a channel that overlap a time. */
  chunksOf(topic: string, fromS = -Infinity, toS = Infinity): Chunk[] {
    const channel = this.channels.get(topic);
    if (channel === undefined) return [];
    return this.chunks.filter(
      (c) => c.lastS >= fromS && c.firstS <= toS && (c.channels === null || c.channels.has(channel)),
    );
  }

  /** All whole messages of the topics, in the order of the file. */
  async *messages(topics: readonly string[]): AsyncGenerator<TopicMessage> {
    const names = new Map(topics.map((t) => [this.channels.get(t) ?? -1, t]));
    const wanted = new Set(topics.flatMap((t) => this.chunksOf(t)));
    for (const group of neighbours(this.chunks.filter((c) => wanted.has(c)))) {
      const at = group[0]!.at;
      const last = group.at(-1)!;
      const bytes = await this.source.read(at, last.at + last.length - at);
      for (const chunk of group)
        for (const m of this.messagesIn(chunk, bytes.subarray(chunk.at - at, chunk.at - at + chunk.length))) {
          const topic = names.get(m.channel);
          if (topic !== undefined) yield { ...m, topic };
        }
    }
  }

  /** Messages of one chunk; none if it is damaged. */
  async unpack(chunk: Chunk): Promise<Message[]> {
    return this.messagesIn(chunk, await this.source.read(chunk.at, chunk.length));
  }

  private messagesIn(chunk: Chunk, record: Uint8Array): Message[] {
    const out: Message[] = [];
    for (const { kind, content } of recordsOf(this.content(chunk, record))) {
      if (kind !== op.message || content.length < messageHead) continue;
      const r = new Bytes(content);
      const channel = r.u16();
      r.u32();
      const timeS = r.u64() * 1e-9;
      r.u64();
      out.push({ channel, timeS, data: r.take(r.left) });
    }
    return out;
  }

  /** The records inside a chunk; nothing if it is damaged. */
  private content(chunk: Chunk, record: Uint8Array): Uint8Array {
    this.unpackedChunks++;
    try {
      return contentOf(record);
    } catch (e) {
      const why = e instanceof ContainerError ? e.message : text('is damaged');
      this.note(text('{from} s to {to} s {why}', { from: fixed(chunk.firstS, 1), to: fixed(chunk.lastS, 1), why }));
      return new Uint8Array(0);
    }
  }

  private note(line: string): void {
    const { damage } = this.index;
    if (damage.length < mostDamageLines && !damage.includes(line)) damage.push(line);
  }
}

/** Of a chunk record, unpacked. */
function contentOf(record: Uint8Array): Uint8Array {
  const r = new Bytes(record);
  r.take(16);
  const size = r.u64();
  if (size > mostChunkBytes) throw new ContainerError(text('is larger than any chunk'));
  const crc = r.u32();
  const compression = r.text();
  const packed = r.take(r.u64());
  if (compression !== 'zstd' && compression !== '')
    throw new ContainerError(text('is compressed by {compression}, which this page cannot read', { compression }));
  const bytes = compression === '' ? packed : decompress(packed, new Uint8Array(size));
  if (bytes.length !== size || crc32(bytes) !== crc) throw new ContainerError(text('is damaged'));
  return bytes;
}

/** Chunks in the order of the file, in groups that are read together. */
function* neighbours(chunks: readonly Chunk[]): Generator<Chunk[]> {
  let group: Chunk[] = [];
  for (const c of chunks) {
    const first = group[0];
    const last = group.at(-1);
    const near = first && last && c.at - last.at - last.length < gapBytes && c.at + c.length - first.at < togetherBytes;
    if (first && !near) {
      yield group;
      group = [];
    }
    group.push(c);
  }
  if (group.length > 0) yield group;
}

/** An attachment that was compressed by itself. */
export function unpacked(attachment: Uint8Array): Uint8Array {
  return decompress(attachment);
}
