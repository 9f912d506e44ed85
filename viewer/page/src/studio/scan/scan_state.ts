// SPDX-License-Identifier: GPL-3.0-or-later
// What the views of a scan show in common.
import type { Choices, Stroke } from '../api';
import type { Block, Vec } from './block';
import type { Preview } from './preview.worker';
import type { Wanted } from './vessel_grid';

/** Share of the voxels that may be darker or brighter than what the window shows. */
const dark = 0.02;
const bright = 0.999;
const mostPoints = 200; // of a stroke

export class ScanState {
  /** The voxel at which all three slices meet. */
  cross: Vec;
  low: number;
  high: number;
  threshold: number;
  label: number | null = null;
  /** mm */
  seed: Vec | null = null;
  aroundMm: number | null = null;
  found: Preview | null = null;
  paint: Stroke[] = [];
  /** What a drag does; null: it moves the crosshair. */
  brush: { erase: boolean; radiusMm: number } | null = null;
  /** The stroke that is being drawn. */
  private drawn: Stroke | null = null;

  constructor(
    readonly block: Block,
    private readonly changed: () => void,
    private readonly painted: (stroke: Stroke) => void,
  ) {
    this.cross = block.size.map((n) => Math.floor(n / 2)) as Vec;
    this.threshold = block.facts.threshold;
    this.low = this.share(dark);
    this.high = Math.max(this.share(bright), this.low + 1e-6);
    if (block.facts.labels.length > 0) [this.low, this.high] = [0, block.facts.most];
  }

  /** Takes what is chosen. */
  take({ threshold, label, seed, aroundMm, paint }: Choices): void {
    this.paint = paint;
    if (threshold !== null) this.threshold = threshold;
    this.label = label;
    const moved = seed && String(seed) !== String(this.seed);
    this.seed = seed;
    this.aroundMm = aroundMm;
    if (moved) this.cross = this.block.voxel(seed);
    this.changed();
  }

  /** Moves the crosshair by some voxels along an axis, or to a voxel. */
  move(axis: number, to: number): void {
    this.cross[axis] = Math.min(this.block.size[axis]! - 1, Math.max(0, Math.round(to)));
    this.changed();
  }

  /** The brush goes over the crosshair. */
  stroke(): void {
    if (!this.brush) return;
    const p = this.block.world(this.cross);
    this.drawn ??= { erase: this.brush.erase, radius_mm: this.brush.radiusMm, points: [] };
    const { points, radius_mm: radius } = this.drawn;
    const last = points[points.length - 1];
    const away = last ? Math.hypot(...p.map((x, a) => x - last[a]!)) : Infinity;
    if (away < radius / 3 || points.length >= mostPoints) return;
    points.push(p);
    this.changed();
  }

  /** The brush is lifted. */
  strokeEnds(): void {
    const { drawn } = this;
    this.drawn = null;
    if (!drawn) return;
    this.paint = [...this.paint, drawn];
    this.painted(drawn);
  }

  window(low: number, high: number): void {
    this.low = low;
    this.high = Math.max(high, low + 1e-6);
    this.changed();
  }

  wanted(): Wanted {
    const [from, to] = this.block.around(this.seed, this.aroundMm);
    return {
      threshold: this.block.storedOf(this.threshold),
      label: this.label === null ? null : this.block.storedOf(this.label),
      seed: this.seed && this.block.voxel(this.seed),
      from,
      to,
      strokes: [...this.paint, ...(this.drawn ? [this.drawn] : [])].map((s) => ({
        erase: s.erase,
        radius: s.radius_mm,
        points: s.points.map((p) => this.block.inVoxels(p)),
      })),
      spacing: this.block.spacing,
    };
  }

  /** The value below which that share of all voxels is. */
  private share(part: number): number {
    const { counts, least, most } = this.block.facts;
    const all = counts.reduce((sum, n) => sum + n, 0);
    let sum = 0;
    const bin = counts.findIndex((n) => (sum += n) >= part * all);
    return least + ((Math.max(0, bin) + 0.5) / Math.max(1, counts.length)) * (most - least);
  }
}
