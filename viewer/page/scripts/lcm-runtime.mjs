// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the generated codec that are the same for every set of types (see gen-lcm.mjs).

export const head = `/** Of one message type. decode throws on a wrong hash, truncation, left-over bytes. */
export interface Codec<T> {
  readonly name: string;
  readonly fingerprint: bigint;
  make(): T;
  encode(message: T): Uint8Array<ArrayBuffer>;
  decode(bytes: Uint8Array): T;
}

function codec<T>(
  name: string, hash: bigint, make: () => T, read: (r: Reader) => T, write: (w: Writer, m: T) => void,
): Codec<T> {
  return {
    name,
    fingerprint: hash,
    make,
    encode: (m) => {
      const w = new Writer();
      w.hash(hash);
      write(w, m);
      return w.bytes();
    },
    decode: (b) => {
      const r = new Reader(b);
      r.hash(hash, name);
      const m = read(r);
      r.end(name);
      return m;
    },
  };
}

const utf8_decoder = new TextDecoder();
const utf8_encoder = new TextEncoder();

function check_length(what: string, got: number, wanted: number): void {
  if (got !== wanted) throw new RangeError(\`\${what} has \${got} entries, its count says \${wanted}\`);
}
`;

export const reader = `  private at = 0;
  private readonly view: DataView;
  constructor(private readonly data: Uint8Array) {
    this.view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  }
  private need(n: number): void {
    if (this.at + n > this.data.byteLength) throw new RangeError('message is truncated');
  }
  private need_many(n: number, size: number): void {
    if (!(n >= 0)) throw new RangeError('negative count');
    this.need(n * size);
  }
  hash(wanted: bigint, name: string): void {
    this.need(8);
    if (this.view.getBigUint64(0) !== wanted) throw new TypeError(\`not a \${name}: fingerprint differs\`);
    this.at = 8;
  }
  end(name: string): void {
    if (this.at !== this.data.byteLength) throw new RangeError(\`\${name}: bytes left over\`);
  }
  boolean(): boolean { return this.int8_t() !== 0; }
  string(): string {
    const n = this.int32_t();
    if (n < 1) throw new RangeError('string without its terminator');
    this.need(n);
    const s = utf8_decoder.decode(this.data.subarray(this.at, this.at + n - 1));
    this.at += n;
    return s;
  }
  list<T>(n: number, read: () => T): T[] {
    this.need_many(n, 1);
    const a: T[] = [];
    for (let i = 0; i < n; i++) a.push(read());
    return a;
  }`;

export const writer = `  private at = 0;
  private buffer = new ArrayBuffer(256);
  private view = new DataView(this.buffer);
  private room(n: number): void {
    if (this.at + n <= this.buffer.byteLength) return;
    const bigger = new ArrayBuffer(Math.max(this.buffer.byteLength * 2, this.at + n));
    new Uint8Array(bigger).set(new Uint8Array(this.buffer));
    this.buffer = bigger;
    this.view = new DataView(bigger);
  }
  bytes(): Uint8Array<ArrayBuffer> { return new Uint8Array(this.buffer, 0, this.at).slice(); }
  hash(v: bigint): void {
    this.room(8);
    this.view.setBigUint64(this.at, v);
    this.at += 8;
  }
  boolean(v: boolean): void { this.int8_t(v ? 1 : 0); }
  string(v: string): void {
    const b = utf8_encoder.encode(v);
    this.int32_t(b.length + 1);
    this.room(b.length + 1);
    new Uint8Array(this.buffer).set(b, this.at);
    this.at += b.length;
    this.view.setUint8(this.at++, 0);
  }`;
