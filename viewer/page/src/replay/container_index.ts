// SPDX-License-Identifier: GPL-3.0-or-later
// What an MCAP file has, and where: from the summary at its end, or, where that is missing or damaged, from its
// records one after another.
import type { ByteSource } from './byte_source';
import {
  Bytes,
  ContainerError,
  crc32,
  footerBytes,
  magic,
  mostChunkBytes,
  op,
  recordHead,
  recordsOf,
} from './mcap_records';
import { text } from '../languages/text';

/** Bytes of the file: a whole record without its head. */
export interface Place {
  at: number;
  length: number;
}

export interface Chunk extends Place {
  firstS: number;
  lastS: number;
  /** Channels with messages in it; null: not said, so it may be any. */
  channels: Set<number> | null;
}

export interface ContainerIndex {
  channels: Map<string, number>;
  /** What a channel says of itself, by topic. */
  said: Map<string, Map<string, string>>;
  metadata: Map<string, Map<string, string>>;
  attachments: Map<string, Place>;
  chunks: Chunk[];
  /** The file was ended properly. */
  ended: boolean;
  /** What could not be read, one line each. */
  damage: string[];
}

/** The file is walked in reads of this size, and a summary is not larger than this. */
const windowBytes = 4 << 20;
const mostSummaryBytes = 256 << 20;
/** First time, last time and size. */
const chunkHeadBytes = 24;
const mostNameBytes = 4096;

const newIndex = (): ContainerIndex => ({
  channels: new Map(),
  said: new Map(),
  metadata: new Map(),
  attachments: new Map(),
  chunks: [],
  ended: false,
  damage: [],
});

/** Throws ContainerError when it is no MCAP file. */
export async function indexOf(source: ByteSource): Promise<ContainerIndex> {
  const begin = await source.read(0, Math.min(source.size, magic.length));
  if (magic.some((b, k) => begin[k] !== b)) throw new ContainerError(text('this is no recorded session'));
  return (await fromSummary(source)) ?? (await fromRecords(source));
}

/** Null: there is no whole summary. */
async function fromSummary(source: ByteSource): Promise<ContainerIndex | null> {
  const tailBytes = recordHead + footerBytes + magic.length;
  if (source.size < magic.length + tailBytes) return null;
  const tail = new Bytes(await source.read(source.size - tailBytes, tailBytes));
  if (tail.u8() !== op.footer || tail.u64() !== footerBytes) return null;
  const at = tail.u64();
  tail.u64();
  const crc = tail.u32();
  const length = source.size - tailBytes - at;
  if (at < magic.length || length <= 0 || length > mostSummaryBytes) return null;
  const crcBytes = 4;
  const bytes = await source.read(at, length + recordHead + footerBytes - crcBytes);
  if (crc32(bytes) !== crc) return null;
  const index = newIndex();
  const described: Place[] = [];
  try {
    for (const { kind, content } of recordsOf(bytes.subarray(0, length))) {
      const r = new Bytes(content);
      if (kind === op.channel) addChannel(index, r);
      else if (kind === op.chunkPlace) index.chunks.push(chunkPlace(r));
      else if (kind === op.attachmentPlace) {
        const place = innerPlace(r);
        r.take(24);
        index.attachments.set(r.text(), place);
      } else if (kind === op.metadataPlace) described.push(innerPlace(r));
    }
    for (const place of described) addMetadata(index, new Bytes(await source.read(place.at, place.length)));
  } catch {
    return null;
  }
  const places = [...index.chunks, ...index.attachments.values()];
  if (places.some((p) => p.at < magic.length || p.length < 0 || p.at + p.length > source.size)) return null;
  index.chunks.sort((a, b) => a.at - b.at);
  index.ended = true;
  return index;
}

/** Of a record that is given with its head. */
function innerPlace(r: Bytes): Place {
  const at = r.u64();
  return { at: at + recordHead, length: r.u64() - recordHead };
}

function chunkPlace(r: Bytes): Chunk {
  const times = { firstS: r.u64() * 1e-9, lastS: r.u64() * 1e-9 };
  const place = innerPlace(r);
  const inside = new Bytes(r.take(r.u32()));
  const channels = new Set<number>();
  while (inside.left > 0) {
    channels.add(inside.u16());
    inside.u64();
  }
  return { ...times, ...place, channels };
}

function addChannel(index: ContainerIndex, r: Bytes): void {
  const id = r.u16();
  r.u16();
  const topic = r.text();
  r.text();
  index.channels.set(topic, id);
  index.said.set(topic, r.pairs());
}

function addMetadata(index: ContainerIndex, r: Bytes): void {
  index.metadata.set(r.text(), r.pairs());
}

/** Reads a source from front to back with few requests. */
class Window {
  private from = 0;
  private bytes: Uint8Array = new Uint8Array(0);

  constructor(private readonly source: ByteSource) {}

  async read(at: number, length: number): Promise<Uint8Array> {
    if (at < this.from || at + length > this.from + this.bytes.length) {
      this.bytes = await this.source.read(at, Math.min(this.source.size - at, Math.max(length, windowBytes)));
      this.from = at;
    }
    return this.bytes.subarray(at - this.from, at - this.from + length);
  }
}

async function fromRecords(source: ByteSource): Promise<ContainerIndex> {
  const index = newIndex();
  const window = new Window(source);
  let at = magic.length;
  while (at + recordHead <= source.size) {
    const head = new Bytes(await window.read(at, recordHead));
    const kind = head.u8();
    const length = head.u64();
    if (kind === op.end) {
      index.ended = true;
      return index;
    }
    const place = { at: at + recordHead, length };
    if (kind === 0 || length > source.size - place.at) {
      index.damage.push(text('the file is cut off or damaged; what is before can be seen'));
      return index;
    }
    try {
      await addRecord(index, kind, place, window);
    } catch (e) {
      if (!(e instanceof ContainerError)) throw e;
      index.damage.push(text('the record at byte {at}: {why}', { at: String(at), why: e.message }));
    }
    at = place.at + length;
  }
  return index;
}

/** Content of chunks and attachments is left where it is. */
async function addRecord(index: ContainerIndex, kind: number, place: Place, window: Window): Promise<void> {
  const content = async (most = place.length) => new Bytes(await window.read(place.at, Math.min(most, place.length)));
  if (kind === op.channel) addChannel(index, await content());
  else if (kind === op.metadata) addMetadata(index, await content());
  else if (kind === op.attachment) {
    const r = await content(mostNameBytes);
    r.take(16);
    index.attachments.set(r.text(), place);
  } else if (kind === op.chunk) {
    const r = await content(chunkHeadBytes);
    const times = { firstS: r.u64() * 1e-9, lastS: r.u64() * 1e-9 };
    if (r.u64() > mostChunkBytes) throw new ContainerError(text('is larger than any chunk'));
    index.chunks.push({ ...times, ...place, channels: null });
  } else if (kind === op.index) {
    const chunk = index.chunks.at(-1);
    if (chunk) (chunk.channels ??= new Set()).add((await content(2)).u16());
  }
}
