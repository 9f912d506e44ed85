// SPDX-License-Identifier: GPL-3.0-or-later
// The voxels of a scan as the page has them: x to the right fastest, then forward, then up (tools/case_builder/
// scan_look.h). Positions are millimetres of the scan, right-anterior-superior.
import { list, number, object, text } from '../../start/api';

export type Vec = [number, number, number];
type Row = [number, number, number, number];
type Twelve = [...Row, ...Row, ...Row];

export interface ScanFacts {
  size: Vec;
  spacingMm: Vec;
  axes: string;
  least: number;
  most: number;
  counts: number[];
  threshold: number;
  labels: { label: number; voxels: number }[];
  block: { size: Vec; toWorld: number[]; bytes: number; scale: number; offset: number };
}

const triple = (value: unknown): Vec => {
  const [x = 0, y = 0, z = 0] = Array.isArray(value) ? value.map(number) : [];
  return [x, y, z];
};

export function scanFactsOf(value: unknown): ScanFacts | null {
  const f = object(value);
  const [block, values, histogram] = [object(f.block), object(f.values), object(f.histogram)];
  if (!Array.isArray(block.to_world) || block.to_world.length !== 12) return null;
  return {
    size: triple(f.size),
    spacingMm: triple(f.spacing_mm),
    axes: text(f.axes),
    least: number(values.least),
    most: number(values.most),
    counts: Array.isArray(histogram.counts) ? histogram.counts.map(number) : [],
    threshold: number(f.threshold),
    labels: list(f.labels).map((l) => ({ label: number(l.label), voxels: number(l.voxels) })),
    block: {
      size: triple(block.size),
      toWorld: block.to_world.map(number),
      bytes: number(block.bytes),
      scale: number(block.scale),
      offset: number(block.offset),
    },
  };
}

/** Inverse of the 3 x 3 part of a 3 x 4 matrix, by rows. */
function inverse(m: readonly number[]): number[] {
  const [a, b, c, , d, e, f, , g, h, i] = m as [
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    ...number[],
  ];
  const [x, y, z] = [e * i! - f * h!, f * g! - d * i!, d * h! - e * g!];
  const det = a * x + b * y + c * z;
  return [
    x, c * h! - b * i!, b * f - c * e,
    y, a * i! - c * g!, c * d - a * f,
    z, b * g! - a * h!, a * e - b * d,
  ].map((v) => v / det); // prettier-ignore
}

export class Block {
  readonly size: Vec;
  readonly spacing: Vec;
  private readonly m: readonly number[];
  private readonly back: number[];

  constructor(
    readonly facts: ScanFacts,
    readonly stored: Uint8Array | Int16Array,
  ) {
    this.size = facts.block.size;
    this.m = facts.block.toWorld;
    this.back = inverse(this.m);
    this.spacing = [0, 1, 2].map((a) => Math.hypot(this.m[a]!, this.m[4 + a]!, this.m[8 + a]!)) as Vec;
  }

  static of(facts: ScanFacts, bytes: ArrayBuffer): Block {
    const stored = facts.block.bytes === 1 ? new Uint8Array(bytes) : new Int16Array(bytes);
    const [x, y, z] = facts.block.size;
    if (stored.length !== x * y * z) throw new Error('the scan has not come whole; load the page again');
    return new Block(facts, stored);
  }

  index(i: number, j: number, k: number): number {
    return i + this.size[0] * (j + this.size[1] * k);
  }
  /** A grey value as it is stored, so that voxels can be compared with it. */
  storedOf(value: number): number {
    return (value - this.facts.block.offset) / this.facts.block.scale;
  }
  valueAt([i, j, k]: Vec): number {
    const { scale, offset } = this.facts.block;
    return offset + scale * this.stored[this.index(i, j, k)]!;
  }
  /** From voxels to the world: three rows of four. */
  toWorld(): Twelve {
    return this.m as Twelve;
  }
  world([i, j, k]: Vec): Vec {
    const { m } = this;
    return [0, 4, 8].map((r) => m[r]! * i + m[r + 1]! * j + m[r + 2]! * k + m[r + 3]!) as Vec;
  }
  /** Of a place, in voxels and parts of them. */
  inVoxels(p: readonly number[]): Vec {
    const d = [0, 1, 2].map((r) => p[r]! - this.m[4 * r + 3]!);
    return [0, 3, 6].map((a) => this.back[a]! * d[0]! + this.back[a + 1]! * d[1]! + this.back[a + 2]! * d[2]!) as Vec;
  }
  /** The nearest one. */
  voxel(p: readonly number[]): Vec {
    return this.inVoxels(p).map((x, a) => Math.min(this.size[a]! - 1, Math.max(0, Math.round(x)))) as Vec;
  }
  /** First and last voxel within `mm` of a point along each axis; all without a point. */
  around(p: readonly number[] | null, mm: number | null): [Vec, Vec] {
    const last = this.size.map((n) => n - 1) as Vec;
    if (!p || mm === null) return [[0, 0, 0], last];
    const at = this.voxel(p);
    const half = this.spacing.map((s) => mm / s);
    return [
      at.map((x, a) => Math.max(0, Math.ceil(x - half[a]!))) as Vec,
      at.map((x, a) => Math.min(last[a]!, Math.floor(x + half[a]!))) as Vec,
    ];
  }
}
