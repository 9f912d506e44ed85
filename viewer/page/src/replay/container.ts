// SPDX-License-Identifier: GPL-3.0-or-later
// Reads an MCAP file (mcap.dev/spec) that lies in memory: whole, without an end, or damaged. The records are walked
// once; a chunk is unpacked when one of its messages is wanted, and checked against its checksum.
import { decompress } from 'fzstd';

const magic = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a];
const op = { header: 1, footer: 2, channel: 4, message: 5, chunk: 6, index: 7, attachment: 9, metadata: 12, end: 15 };
const recordHead = 9;
const messageHead = 22;
/** No writer makes larger chunks. */
const mostChunkBytes = 64 << 20;

export class ContainerError extends Error {}

export interface Message {
  channel: number;
  timeS: number;
  data: Uint8Array;
}

export interface Chunk {
  firstS: number;
  lastS: number;
  /** Bytes before compression, and the checksum of them. */
  size: number;
  crc: number;
  compression: string;
  packed: Uint8Array;
  /** Channels with messages in it; null: not said, so it may be any. */
  channels: Set<number> | null;
}

/** Reads numbers and strings from front to back; throws when the bytes end too early. */
class Bytes {
  at = 0;
  private readonly view: DataView;

  constructor(private readonly bytes: Uint8Array) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }
  get left(): number {
    return this.bytes.length - this.at;
  }
  take(n: number): Uint8Array {
    if (n > this.left) throw new ContainerError('ends too early');
    this.at += n;
    return this.bytes.subarray(this.at - n, this.at);
  }
  private number(size: number): number {
    this.take(size);
    return this.at - size;
  }
  u8(): number {
    return this.view.getUint8(this.number(1));
  }
  u16(): number {
    return this.view.getUint16(this.number(2), true);
  }
  u32(): number {
    return this.view.getUint32(this.number(4), true);
  }
  /** Exact up to 2^53. */
  u64(): number {
    const low = this.u32();
    return low + this.u32() * 4294967296;
  }
  text(): string {
    return new TextDecoder().decode(this.take(this.u32()));
  }
  pairs(): Map<string, string> {
    const inside = new Bytes(this.take(this.u32()));
    const out = new Map<string, string>();
    while (inside.left > 0) out.set(inside.text(), inside.text());
    return out;
  }
}

export class Container {
  readonly channels = new Map<string, number>();
  private readonly said = new Map<string, Map<string, string>>();
  readonly metadata = new Map<string, Map<string, string>>();
  readonly attachments = new Map<string, Uint8Array>();
  /** The file was ended properly. */
  ended = false;
  /** What could not be read, one line each. */
  readonly damage: string[] = [];
  readonly chunks: Chunk[] = [];
  /** How many chunks were unpacked until now. */
  unpackedChunks = 0;
  private last: { chunk: Chunk; bytes: Uint8Array } | null = null;

  constructor(private readonly bytes: Uint8Array) {
    if (magic.some((b, k) => bytes[k] !== b)) throw new ContainerError('this is no recorded session');
    this.walk();
  }

  /** What whole numbers of a topic are multiples of; 1 if it does not say. */
  unitOf(topic: string): number {
    return Number(this.said.get(topic)?.get('unit') ?? 1) || 1;
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
  *messages(topics: readonly string[]): Generator<Message & { topic: string }> {
    const names = new Map(topics.map((t) => [this.channels.get(t) ?? -1, t]));
    const wanted = new Set(topics.flatMap((t) => this.chunksOf(t)));
    for (const chunk of this.chunks)
      if (wanted.has(chunk))
        for (const m of this.unpack(chunk)) {
          const topic = names.get(m.channel);
          if (topic !== undefined) yield { ...m, topic };
        }
  }

  /** Messages of one chunk; none if it is damaged. */
  unpack(chunk: Chunk): Message[] {
    const bytes = this.content(chunk);
    const out: Message[] = [];
    if (!bytes) return out;
    const records = new Bytes(bytes);
    while (records.left >= recordHead) {
      const kind = records.u8();
      const length = records.u64();
      if (length > records.left) break;
      const record = new Bytes(records.take(length));
      if (kind !== op.message || length < messageHead) continue;
      const channel = record.u16();
      record.u32();
      const timeS = record.u64() * 1e-9;
      record.u64();
      out.push({ channel, timeS, data: record.take(record.left) });
    }
    return out;
  }

  private content(chunk: Chunk): Uint8Array | null {
    if (this.last?.chunk === chunk) return this.last.bytes;
    this.unpackedChunks++;
    try {
      if (chunk.compression !== 'zstd' && chunk.compression !== '')
        throw new ContainerError(`is compressed by ${chunk.compression}, which this page cannot read`);
      const bytes = chunk.compression === '' ? chunk.packed : decompress(chunk.packed, new Uint8Array(chunk.size));
      if (bytes.length !== chunk.size || crc32(bytes) !== chunk.crc) throw new ContainerError('is damaged');
      this.last = { chunk, bytes };
      return bytes;
    } catch (e) {
      const why = e instanceof ContainerError ? e.message : 'is damaged';
      this.note(`${chunk.firstS.toFixed(1)} s to ${chunk.lastS.toFixed(1)} s ${why}`);
      return null;
    }
  }

  private note(line: string): void {
    if (this.damage.length < 100 && !this.damage.includes(line)) this.damage.push(line);
  }

  private walk(): void {
    let at = magic.length;
    while (at + recordHead <= this.bytes.length) {
      const head = new Bytes(this.bytes.subarray(at, at + recordHead));
      const kind = head.u8();
      const length = head.u64();
      if (kind === op.end) {
        this.ended = true;
        return;
      }
      if (kind === 0 || length > this.bytes.length - at - recordHead) {
        this.note('the file is cut off or damaged; what is before can be seen');
        return;
      }
      try {
        this.record(kind, new Bytes(this.bytes.subarray(at + recordHead, at + recordHead + length)));
      } catch (e) {
        if (!(e instanceof ContainerError)) throw e;
        this.note(`the record at byte ${at} ${e.message}`);
      }
      at += recordHead + length;
    }
  }

  private record(kind: number, r: Bytes): void {
    if (kind === op.channel) {
      const id = r.u16();
      r.u16();
      const topic = r.text();
      r.text();
      this.channels.set(topic, id);
      this.said.set(topic, r.pairs());
    } else if (kind === op.metadata) this.metadata.set(r.text(), r.pairs());
    else if (kind === op.attachment) {
      r.u64();
      r.u64();
      const name = r.text();
      r.text();
      this.attachments.set(name, r.take(r.u64()));
    } else if (kind === op.chunk) {
      const times = { firstS: r.u64() * 1e-9, lastS: r.u64() * 1e-9 };
      const size = r.u64();
      if (size > mostChunkBytes) throw new ContainerError('is larger than any chunk');
      const crc = r.u32();
      const compression = r.text();
      this.chunks.push({ ...times, size, crc, compression, packed: r.take(r.u64()), channels: null });
    } else if (kind === op.index) {
      const chunk = this.chunks[this.chunks.length - 1];
      if (chunk) (chunk.channels ??= new Set()).add(r.u16());
    }
  }
}

/** An attachment that was compressed by itself. */
export function unpacked(attachment: Uint8Array): Uint8Array {
  return decompress(attachment);
}

const crcTable = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; k++) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c;
});

/** Of IEEE 802.3. */
export function crc32(bytes: Uint8Array): number {
  let c = 0xffffffff;
  for (const b of bytes) c = crcTable[(c ^ b) & 0xff]! ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}
