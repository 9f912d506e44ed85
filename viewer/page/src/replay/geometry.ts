// SPDX-License-Identifier: GPL-3.0-or-later
// The geometry of recorded pictures (docs/session-format.md): whole multiples of a unit, as differences from the
// picture before.
import type { RenderFrame } from '../lcm';
import { text } from '../languages/text';

const unknown = -0x80000000;

interface List {
  kind: number;
  index: number;
  coded: Int32Array;
}

export type Geometry = Pick<RenderFrame, 'body' | 'drawable'>;

export class GeometryError extends Error {}

/** Takes pictures in order, from a complete one on. */
export class GeometryDecoder {
  private last: List[] | null = null;

  constructor(private readonly unit: number) {}

  /** Throws GeometryError for bytes that are no picture, or that need the picture before. */
  decode(bytes: Uint8Array): Geometry {
    const before = this.last;
    this.last = null;
    const now = read(bytes, before);
    this.last = now;
    const floats = (coded: Int32Array) =>
      Float32Array.from(coded, (c) => (c === unknown ? NaN : Math.fround(c * this.unit)));
    const of = (kind: number) => now.filter((l) => l.kind === kind);
    return {
      body: of(0).map((l) => ({ index: l.index, nodes: l.coded.length / 3, x_m: floats(l.coded) })),
      drawable: of(1).map((l) => ({ index: l.index, floats: l.coded.length, data: floats(l.coded) })),
    };
  }
}

function read(bytes: Uint8Array, before: List[] | null): List[] {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const need = (at: number, n: number) => {
    if (at + n > bytes.length) throw new GeometryError(text('a picture ends too early'));
  };
  need(0, 5);
  const key = bytes[0] === 1;
  if (!key && !before) throw new GeometryError(text('the picture before is missing'));
  const lists: List[] = [];
  let at = 5;
  for (let n = view.getUint32(1, true); n > 0; n--) {
    need(at, 10);
    const kind = bytes[at]!;
    const width = bytes[at + 1]!;
    const index = view.getInt32(at + 2, true);
    const count = view.getUint32(at + 6, true);
    at += 10;
    if (kind > 1 || width > 4 || (kind === 0 && count % 3 !== 0)) throw new GeometryError(text('this is no picture'));
    need(at, width * count);
    const old = key ? undefined : before?.[lists.length];
    const same = old?.kind === kind && old.index === index && old.coded.length === count;
    lists.push({
      kind,
      index,
      coded: unplane(bytes.subarray(at, at + width * count), width, count, same ? old.coded : null),
    });
    at += width * count;
  }
  if (at !== bytes.length) throw new GeometryError(text('a picture has too many bytes'));
  return lists;
}

/** The low bytes of all differences come first. An odd difference is negative. */
function unplane(planes: Uint8Array, width: number, count: number, before: Int32Array | null): Int32Array {
  const out = new Int32Array(count);
  for (let k = 0; k < count; k++) {
    let z = 0;
    for (let p = 0; p < width; p++) z |= planes[p * count + k]! << (8 * p);
    out[k] = ((z >>> 1) ^ -(z & 1)) + (before ? before[k]! : 0);
  }
  return out;
}
