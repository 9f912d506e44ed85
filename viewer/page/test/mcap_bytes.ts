// SPDX-License-Identifier: GPL-3.0-or-later
// Writes small MCAP files without compression, for tests of their reader.
import { crc32 } from '../src/replay/mcap_records';

const utf8 = new TextEncoder();

class Out {
  private readonly parts: Uint8Array[] = [];

  number(value: number, size: number): this {
    const bytes = new Uint8Array(size);
    for (let k = 0; k < size; k++) bytes[k] = Math.floor(value / 256 ** k) % 256;
    this.parts.push(bytes);
    return this;
  }
  raw(bytes: Uint8Array): this {
    this.parts.push(bytes);
    return this;
  }
  text(s: string): this {
    const bytes = utf8.encode(s);
    return this.number(bytes.length, 4).raw(bytes);
  }
  pairs(map: Record<string, string>): this {
    const inside = new Out();
    for (const [k, v] of Object.entries(map)) inside.text(k).text(v);
    const bytes = inside.bytes();
    return this.number(bytes.length, 4).raw(bytes);
  }
  bytes(): Uint8Array {
    const out = new Uint8Array(this.parts.reduce((n, p) => n + p.length, 0));
    let at = 0;
    for (const p of this.parts) {
      out.set(p, at);
      at += p.length;
    }
    return out;
  }
}

const record = (op: number, content: Uint8Array): Uint8Array =>
  new Out().number(op, 1).number(content.length, 8).raw(content).bytes();

export interface TestMessage {
  channel: number;
  timeS: number;
  data: Uint8Array | string;
}

const magic = Uint8Array.of(0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a);
const nsOf = (m: TestMessage): number => Math.round(m.timeS * 1e9);

export class McapBytes {
  private readonly out = new Out().raw(magic);
  /** The records of the summary. */
  private readonly summary = new Out();

  constructor() {
    this.out.raw(record(1, new Out().text('insula').text('test').bytes()));
  }
  channel(id: number, topic: string, metadata: Record<string, string> = {}): this {
    const one = record(4, new Out().number(id, 2).number(0, 2).text(topic).text('json').pairs(metadata).bytes());
    this.out.raw(one);
    this.summary.raw(one);
    return this;
  }
  metadata(name: string, map: Record<string, string>): this {
    const one = record(12, new Out().text(name).pairs(map).bytes());
    this.summary.raw(record(13, this.place(one).text(name).bytes()));
    this.out.raw(one);
    return this;
  }
  attachment(name: string, data: Uint8Array): this {
    const content = new Out().number(0, 16).text(name).text('').number(data.length, 8).raw(data).number(0, 4);
    const one = record(9, content.bytes());
    this.summary.raw(record(10, this.place(one).number(0, 16).number(data.length, 8).text(name).text('').bytes()));
    this.out.raw(one);
    return this;
  }
  /** One chunk with its index. */
  chunk(messages: readonly TestMessage[]): this {
    const inside = new Out();
    for (const m of messages) {
      const data = typeof m.data === 'string' ? utf8.encode(m.data) : m.data;
      const head = new Out().number(m.channel, 2).number(0, 4).number(nsOf(m), 8).number(nsOf(m), 8);
      inside.raw(record(5, head.raw(data).bytes()));
    }
    const bytes = inside.bytes();
    const times = messages.map(nsOf);
    const between = () => new Out().number(Math.min(...times), 8).number(Math.max(...times), 8);
    const content = between().number(bytes.length, 8).number(crc32(bytes), 4).text('').number(bytes.length, 8);
    const one = record(6, content.raw(bytes).bytes());
    const ids = [...new Set(messages.map((m) => m.channel))];
    const indices = new Out();
    for (const id of ids) indices.number(id, 2).number(0, 8);
    const place = between().raw(this.place(one).bytes()).number(indices.bytes().length, 4).raw(indices.bytes());
    this.summary.raw(record(8, place.number(0, 8).text('').number(0, 16).bytes()));
    this.out.raw(one);
    for (const id of ids) this.out.raw(record(7, new Out().number(id, 2).number(0, 4).bytes()));
    return this;
  }
  end(): Uint8Array {
    const data = new Out()
      .raw(this.open())
      .raw(record(15, new Out().number(0, 4).bytes()))
      .bytes();
    const footer = new Out().number(2, 1).number(20, 8).number(data.length, 8).number(0, 8);
    const covered = new Out().raw(this.summary.bytes()).raw(footer.bytes()).bytes();
    return new Out().raw(data).raw(covered).number(crc32(covered), 4).raw(magic).bytes();
  }
  /** As a program leaves it that dies. */
  open(): Uint8Array {
    return this.out.bytes();
  }

  /** Where the next record will be, and its length. */
  private place(one: Uint8Array): Out {
    return new Out().number(this.out.bytes().length, 8).number(one.length, 8);
  }
}
