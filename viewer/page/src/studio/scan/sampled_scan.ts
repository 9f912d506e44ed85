// SPDX-License-Identifier: GPL-3.0-or-later
// A scan on the nodes of a coarser grid. All its voxels are read once, and not again while only the threshold moves.
import type { Vec } from './block';

export type Stored = Uint8Array | Int16Array;

export interface Part {
  /** The first voxel of the first node. */
  from: Vec;
  /** In nodes. */
  size: Vec;
  /** Voxels a node. */
  step: number;
  /** In place of grey values: 1 where a voxel has this label, else 0. */
  label: number | null;
}

export class SampledScan {
  /** Voxels that were read so far. */
  read = 0;
  private kept: { key: string; brightest: Stored } | null = null;

  constructor(
    readonly stored: Stored,
    readonly size: Vec,
  ) {}

  /** The brightest voxel of each node, so that thin vessels stay connected. */
  brightest(part: Part): Stored {
    const key = JSON.stringify(part);
    if (this.kept?.key !== key) this.kept = { key, brightest: this.sample(part) };
    return this.kept.brightest;
  }

  private sample({ from, size, step, label }: Part): Stored {
    const { stored } = this;
    const [nx, ny] = this.size;
    const out = stored.slice(0, size[0] * size[1] * size[2]);
    for (let k = 0, first = 0; k < size[2]; k++)
      for (let j = 0; j < size[1]; j++, first += size[0])
        for (let row = 0; row < step * step; row++) {
          const [b, c] = [row % step, Math.floor(row / step)];
          let v = from[0] + nx * (from[1] + j * step + b + ny * (from[2] + k * step + c));
          for (let n = first; n < first + size[0]; n++) {
            let most = row === 0 ? -Infinity : out[n]!;
            for (const end = v + step; v < end; v++) {
              const value = stored[v]!;
              const s = label === null ? value : value === label ? 1 : 0;
              if (s > most) most = s;
            }
            out[n] = most;
          }
        }
    this.read += out.length * step ** 3;
    return out;
  }
}
