// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes that are read where they lie, a part at a time. A recording of hours need not fit into memory.
import { text } from '../languages/text';

export interface ByteSource {
  readonly size: number;
  /** Throws when there are not so many bytes, or when they cannot be read. */
  read(at: number, length: number): Promise<Uint8Array>;
}

function checkRange(size: number, at: number, length: number): void {
  if (at < 0 || length < 0 || at + length > size)
    throw new RangeError(
      text('no bytes {from} to {to} of {size}', { from: String(at), to: String(at + length), size: String(size) }),
    );
}

/** A file that a person has chosen. */
export class BlobSource implements ByteSource {
  readonly size: number;

  constructor(private readonly blob: Blob) {
    this.size = blob.size;
  }
  async read(at: number, length: number): Promise<Uint8Array> {
    checkRange(this.size, at, length);
    return new Uint8Array(await this.blob.slice(at, at + length).arrayBuffer());
  }
}

const blockBytes = 1 << 18;
const keptBlocks = 64;

/** Reads a source by blocks and keeps the last ones: small parts that lie side by side cost one request. */
export class BlockSource implements ByteSource {
  readonly size: number;
  private readonly blocks = new Map<number, Promise<Uint8Array>>();

  constructor(private readonly source: ByteSource) {
    this.size = source.size;
  }

  /** What is larger than a block is read as it is. */
  async read(at: number, length: number): Promise<Uint8Array> {
    checkRange(this.size, at, length);
    if (length > blockBytes) return this.source.read(at, length);
    const out = new Uint8Array(length);
    const first = Math.floor(at / blockBytes);
    for (let n = first; n * blockBytes < at + length; n++) {
      const block = await this.block(n);
      const from = Math.max(at, n * blockBytes);
      const to = Math.min(at + length, (n + 1) * blockBytes);
      out.set(block.subarray(from - n * blockBytes, to - n * blockBytes), from - at);
    }
    return out;
  }

  private block(n: number): Promise<Uint8Array> {
    const at = n * blockBytes;
    const found = this.blocks.get(n) ?? this.source.read(at, Math.min(blockBytes, this.size - at));
    this.blocks.delete(n);
    this.blocks.set(n, found);
    if (this.blocks.size > keptBlocks) this.blocks.delete(this.blocks.keys().next().value!);
    // One that could not be read is asked for again.
    found.catch(() => this.blocks.delete(n));
    return found;
  }
}

/** Status of an answer for a range beyond the end, as that of an empty file. */
const noSuchBytes = 416;

/** A file of a server that answers requests for ranges (RFC 9110, 14). It may answer with a shorter one. */
export class RemoteSource implements ByteSource {
  private constructor(
    private readonly url: string,
    readonly size: number,
  ) {}

  static async open(url: string): Promise<RemoteSource> {
    const first = await fetch(url, { headers: { range: 'bytes=0-0' }, cache: 'no-store' });
    if (first.status !== noSuchBytes) await answered(Promise.resolve(first));
    const size = /\/(\d+)$/.exec(first.headers.get('content-range') ?? '')?.[1];
    if (size === undefined) throw new Error(text('the server gives no parts of a file'));
    return new RemoteSource(url, Number(size));
  }

  async read(at: number, length: number): Promise<Uint8Array> {
    checkRange(this.size, at, length);
    const first = await this.part(at, length);
    if (first.length === length) return first;
    const whole = new Uint8Array(length);
    whole.set(first);
    for (let n = first.length; n < length;) {
      const part = await this.part(at + n, length - n);
      whole.set(part, n);
      n += part.length;
    }
    return whole;
  }

  private async part(at: number, length: number): Promise<Uint8Array> {
    if (length === 0) return new Uint8Array(0);
    const headers = { range: `bytes=${at}-${at + length - 1}` };
    const response = await answered(fetch(this.url, { headers, cache: 'no-store' }));
    if (response.status !== 206) throw new Error(text('the server gives no parts of a file'));
    const bytes = new Uint8Array(await response.arrayBuffer());
    if (bytes.length === 0 || bytes.length > length)
      throw new Error(text('the server gave {count} bytes', { count: bytes.length }));
    return bytes;
  }
}

/** Throws what the server says if it refuses. */
export async function answered(request: Promise<Response>): Promise<Response> {
  const response = await request;
  if (!response.ok) throw new Error((await response.text()).trim() || `${response.status} ${response.statusText}`);
  return response;
}
