// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the vessel in a scan and its surface, beside the page's own thread.
import type { Vec } from './block';
import { SampledScan, type Stored } from './sampled_scan';
import { surfaceNet } from './surface_net';
import { vesselGrid, type VesselGrid, type Wanted } from './vessel_grid';

export type Ask = { stored: Stored; size: Vec } | { wanted: Wanted };

export interface Preview {
  grid: Pick<VesselGrid, 'size' | 'step' | 'from' | 'part'>;
  positions: Float32Array;
  triangles: Uint32Array;
  ms: number;
}

let scan: SampledScan | null = null;

self.onmessage = ({ data }: MessageEvent<Ask>) => {
  if ('stored' in data) {
    scan = new SampledScan(data.stored, data.size);
    return;
  }
  if (!scan) return;
  const began = performance.now();
  const { size, step, from, part, level } = vesselGrid(scan, data.wanted);
  const { positions, triangles } = surfaceNet(size, level);
  const answer: Preview = { grid: { size, step, from, part }, positions, triangles, ms: performance.now() - began };
  self.postMessage(answer, { transfer: [part.buffer, positions.buffer, triangles.buffer] });
};
