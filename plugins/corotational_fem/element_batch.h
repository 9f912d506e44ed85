// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedra in batches of eight, stored quantity by quantity, and the loops over them. The loops are compiled once per
// instruction set (kernels_impl.cpp) and chosen at run time. An element's result does not depend on its companions. The
// bits depend on the instruction set, never on the build type.
#pragma once

namespace insula {

inline constexpr int batch_lanes = 8;

/// Nodes are in the order of the matrix, so no block is stored transposed. Lanes past `count` repeat the last element.
struct alignas(64) ElementBatch {
  double b[3][3][batch_lanes];  ///< rest gradients of nodes 1 to 3, 1/m; node 0 has minus their sum
  double volume[batch_lanes];   ///< at rest, m3
  double q[4][batch_lanes];     ///< rotation of the last linearisation, unit quaternion w x y z
  int node[4][batch_lanes];
  int slot[10][batch_lanes];  ///< blocks (0,0) (1,0) (1,1) (2,0) ...; -1 where a node is fixed
  int count;
};

struct ElementMaterial {
  double mu, lambda;           ///< Pa
  double far2;                 ///< squared norm of the strain above which the barrier may act; infinite: never
  double swelling_stress = 0;  ///< (2 mu + 3 lambda)(natural stretch - 1), Pa; compresses what cannot expand
};

/// Intermediate results that one loop passes to the next.
struct alignas(64) ElementWork {
  double f[9][batch_lanes];  ///< deformation gradient, row by row
  double r[9][batch_lanes];  ///< its rotation, row by row
  double q[4][batch_lanes];
  double s[6][batch_lanes];  ///< stretch: 00 11 22 01 02 12
  double out[12][batch_lanes];
};

enum class SpinTerm { none, exact, positive };

struct ElementKernels {
  /// F of each element and, from the batch's q, its rotation. Returns the lanes (bits) whose rotation was not found.
  unsigned (*rotate)(const ElementBatch& batch, const double* x, ElementWork& work);
  /// Stretch, and force += -dE/dx. Returns the lanes in which the barrier may act.
  unsigned (*force)(const ElementBatch& batch, const ElementMaterial& m, ElementWork& work, double* force);
  /// values (3x3 blocks, column-major) += scale d2E/dx2: Hooke's law in the rotated frame and the spin of the element.
  void (*stiffness)(const ElementBatch& batch, const ElementMaterial& m, const ElementWork& work, double scale,
                    SpinTerm spin, double* values);
  /// Stretch, and each lane's energy in work.out[0]. Returns the lanes in which the barrier may act.
  unsigned (*energy)(const ElementBatch& batch, const ElementMaterial& m, ElementWork& work);
};

/// The loops for the instruction set of kernels() in core/linalg.
const ElementKernels& element_kernels();

}  // namespace insula
