// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of one slice, a pixel each voxel. What would be vessel is coloured.
import type { ScanState } from './scan_state';

const kept = [255, 90, 70] as const;
const other = [90, 150, 255] as const; // further pieces
const tint = 0.5;

/** Along one axis: by how much a voxel moves the index of its node on the preview's grid. Outside of the part: -1. */
function nodeOffsets(state: ScanState, axis: 0 | 1 | 2): Int32Array {
  const { from, to } = state.wanted();
  const grid = state.found?.grid;
  const across = grid ? [1, grid.size[0], grid.size[0] * grid.size[1]][axis]! : 0;
  return Int32Array.from({ length: state.block.size[axis] }, (_, x) => {
    if (x < from[axis] || x > to[axis]) return -1;
    if (!grid) return 0;
    return across * Math.min(grid.size[axis] - 1, Math.max(0, Math.floor((x - grid.from[axis]) / grid.step)));
  });
}

/** u runs to the left, v up. */
export function slicePixels(state: ScanState, axis: 0 | 1 | 2, { u, v }: { u: 0 | 1; v: 1 | 2 }): ImageData {
  const { block, found } = state;
  const [nu, nv] = [block.size[u], block.size[v]];
  const pixels = new ImageData(nu, nv);
  const { threshold, label, strokes } = state.wanted();
  const [low, high] = [block.storedOf(state.low), block.storedOf(state.high)];
  const grey = 255 / (high - low);
  // What was painted is known on the nodes of the preview.
  const byNode = strokes.length > 0 && found !== null;
  const through = nodeOffsets(state, axis)[state.cross[axis]]!;
  const [alongU, alongV] = [nodeOffsets(state, u), nodeOffsets(state, v)];
  const across = [1, block.size[0], block.size[0] * block.size[1]];
  let to = 0;
  for (let y = nv - 1; y >= 0; y--) {
    const row = state.cross[axis] * across[axis]! + y * across[v]!;
    const taken = through >= 0 && alongV[y]! >= 0;
    for (let x = nu - 1; x >= 0; x--, to += 4) {
      const stored = block.stored[row + x * across[u]!]!;
      const value = Math.min(255, Math.max(0, (stored - low) * grey));
      const vessel = byNode || (label === null ? stored >= threshold : stored === label);
      const inside = vessel && taken && alongU[x]! >= 0;
      const part = inside && found ? found.grid.part[through + alongV[y]! + alongU[x]!]! : 0;
      const coloured = inside && !(byNode && part === 0);
      const colour = part === 2 ? other : kept;
      for (let c = 0; c < 3; c++) pixels.data[to + c] = coloured ? value * (1 - tint) + colour[c]! * tint : value;
      pixels.data[to + 3] = 255;
    }
  }
  return pixels;
}
