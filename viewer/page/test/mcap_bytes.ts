// SPDX-License-Identifier: GPL-3.0-or-later
// Writes small MCAP files without compression, for tests of their reader.
import { crc32 } from '../src/replay/container';

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

export class McapBytes {
  private readonly out = new Out().raw(Uint8Array.of(0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a));

  constructor() {
    this.out.raw(record(1, new Out().text('insula').text('test').bytes()));
  }
  channel(id: number, topic: string, metadata: Record<string, string> = {}): this {
    this.out.raw(record(4, new Out().number(id, 2).number(0, 2).text(topic).text('json').pairs(metadata).bytes()));
    return this;
  }
  metadata(name: string, map: Record<string, string>): this {
    this.out.raw(record(12, new Out().text(name).pairs(map).bytes()));
    return this;
  }
  attachment(name: string, data: Uint8Array): this {
    const content = new Out().number(0, 16).text(name).text('').number(data.length, 8).raw(data).number(0, 4);
    this.out.raw(record(9, content.bytes()));
    return this;
  }
  /** One chunk with its index. */
  chunk(messages: readonly TestMessage[]): this {
    const inside = new Out();
    for (const m of messages) {
      const data = typeof m.data === 'string' ? utf8.encode(m.data) : m.data;
      const ns = Math.round(m.timeS * 1e9);
      inside.raw(record(5, new Out().number(m.channel, 2).number(0, 4).number(ns, 8).number(ns, 8).raw(data).bytes()));
    }
    const bytes = inside.bytes();
    const times = messages.map((m) => Math.round(m.timeS * 1e9));
    const content = new Out().number(Math.min(...times), 8).number(Math.max(...times), 8);
    content.number(bytes.length, 8).number(crc32(bytes), 4).text('').number(bytes.length, 8).raw(bytes);
    this.out.raw(record(6, content.bytes()));
    for (const id of new Set(messages.map((m) => m.channel)))
      this.out.raw(record(7, new Out().number(id, 2).number(0, 4).bytes()));
    return this;
  }
  end(): Uint8Array {
    return new Out()
      .raw(this.open())
      .raw(record(15, new Out().number(0, 4).bytes()))
      .bytes();
  }
  /** As a program leaves it that dies. */
  open(): Uint8Array {
    return this.out.bytes();
  }
}
