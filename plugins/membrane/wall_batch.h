// SPDX-License-Identifier: GPL-3.0-or-later
// Hinges and triangles of a wall in batches of eight, stored quantity by quantity, and the loops over them. The loops
// are compiled once per instruction set (kernels_impl.cpp) and chosen at run time. The result of one lane does not
// depend on the others.
#pragma once

namespace insula {

inline constexpr int wall_lanes = 8;

/// Lanes past `count` repeat the last one.
struct alignas(64) HingeBatch {
  double least[2][wall_lanes];  ///< WallHinge::least
  int node[4][wall_lanes];
  int count;
};
struct alignas(64) TriangleBatch {
  double b[3][2][wall_lanes];                 ///< rest gradients of the shape functions, 1/m
  double mu[wall_lanes], lambda[wall_lanes];  ///< times area and thickness, N m
  double pre[3][wall_lanes];                  ///< prestrain: 00, 01, 11
  int node[3][wall_lanes];
  int count;
};

struct WallKernels {
  /// Angles of a batch's hinges, rad. Each is the multiple nearest to the value that `angle` holds. Also writes their
  /// gradients, 1/m, if `gradient` is given (16 values for each hinge, three for each node padded to four).
  void (*hinges)(const HingeBatch& batch, const double* x, double* angle, double* gradient);
  /// force += -dE/dx of the triangles' stretch.
  void (*stretch)(const TriangleBatch& batch, const double* x, double* force);
};

/// The loops for the instruction set of kernels() in core/linalg.
const WallKernels& wall_kernels();

}  // namespace insula
