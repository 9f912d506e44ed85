// SPDX-License-Identifier: GPL-3.0-or-later
// The inner loop of bending. It adds B^T B of one patch to the system matrix. It is compiled for the processor's
// vectors. No sums are reordered or fused, so every instruction set gives the same bits.
#pragma once

namespace insula {

constexpr int patch_nodes = 12;

/// A patch's rows. Each node i and row m has three entries b, laid out so that a block is one product of vectors.
struct PatchRows {
  alignas(64) double row[patch_nodes][3][4];     ///< b, padded
  alignas(64) double tiled[patch_nodes][3][8];   ///< b0 b1 b2 b0 b1 b2 b0 b1
  alignas(64) double spread[patch_nodes][3][8];  ///< b0 b0 b0 b1 b1 b1 b2 b2
};

/// values: 3x3 blocks, column-major. slot: of (0,0) (1,0) (1,1) ..., negative if nothing is stored.
void add_patch(PatchRows& rows, int nodes, const int* slot, double* values);

}  // namespace insula
