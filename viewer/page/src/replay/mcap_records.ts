// SPDX-License-Identifier: GPL-3.0-or-later
// The records of an MCAP file (mcap.dev/spec), as far as the page reads them.
import { text } from '../languages/text';

export const magic = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a];
export const op = {
  footer: 2,
  channel: 4,
  message: 5,
  chunk: 6,
  index: 7,
  chunkPlace: 8,
  attachment: 9,
  attachmentPlace: 10,
  metadata: 12,
  metadataPlace: 13,
  end: 15,
};
/** Kind and length before each record's content. */
export const recordHead = 9;
export const messageHead = 22;
/** Where the summary begins, where its offsets begin, checksum of the summary. */
export const footerBytes = 20;
/** No writer makes larger chunks. */
export const mostChunkBytes = 64 << 20;

export class ContainerError extends Error {}

/** Reads numbers and strings from front to back; throws when the bytes end too early. */
export class Bytes {
  at = 0;
  private readonly view: DataView;

  constructor(private readonly bytes: Uint8Array) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }
  get left(): number {
    return this.bytes.length - this.at;
  }
  take(n: number): Uint8Array {
    if (n > this.left) throw new ContainerError(text('ends too early'));
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

/** One record after another; what is cut off at the end is left out. */
export function* recordsOf(bytes: Uint8Array): Generator<{ kind: number; content: Uint8Array }> {
  const r = new Bytes(bytes);
  while (r.left >= recordHead) {
    const kind = r.u8();
    const length = r.u64();
    if (length > r.left) return;
    yield { kind, content: r.take(length) };
  }
}

/** Remainders of a byte that is followed by 0, 1, 2 or 3 zero bytes, one table after another. */
const crcTables = crcRemainders();

function crcRemainders(): Uint32Array {
  const t = new Uint32Array(4 * 256);
  for (let n = 0; n < 256; n++) {
    let c = n;
    for (let k = 0; k < 8; k++) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
    t[n] = c;
  }
  for (let n = 256; n < t.length; n++) t[n] = t[t[n - 256]! & 0xff]! ^ (t[n - 256]! >>> 8);
  return t;
}

/** Of IEEE 802.3; four bytes at a time (Kounavis, Berry: Novel table lookup-based algorithms for CRC, 2008). */
export function crc32(bytes: Uint8Array): number {
  const t = crcTables;
  const fours = bytes.length - (bytes.length % 4);
  let c = 0xffffffff;
  let i = 0;
  for (; i < fours; i += 4) {
    c ^= bytes[i]! | (bytes[i + 1]! << 8) | (bytes[i + 2]! << 16) | (bytes[i + 3]! << 24);
    c = t[768 + (c & 0xff)]! ^ t[512 + ((c >>> 8) & 0xff)]! ^ t[256 + ((c >>> 16) & 0xff)]! ^ t[c >>> 24]!;
  }
  for (; i < bytes.length; i++) c = t[(c ^ bytes[i]!) & 0xff]! ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}
