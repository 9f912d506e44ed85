// SPDX-License-Identifier: GPL-3.0-or-later
// One sweep of block Gauss-Seidel, the solver's inner loop, compiled once per instruction set. When a row's lambda
// changes, delta = W lambda + delta_free changes by its column of W. W is symmetric, so this is its row, which is read
// as one stream.
#pragma once
#include "core/constraint/block.h"

namespace insula {

struct ConstraintProblem;

/// Data of a block for its local solution, computed once in each solve.
struct LocalBlock {
  int row = 0;
  LawKind law = LawKind::box;
  bool regular = false;  ///< the block of W is well enough conditioned for its inverse and the slip equation below
  int normals = 0;
  double compliance = 0, lower = 0, upper = 0, friction = 0;
  double inverse[6] = {};    ///< of W + compliance: box one number; friction nn n1 n2 11 12 22; patch 11 12 22
  double vx = 1, vy = 0;     ///< eigenvector of the larger eigenvalue of the tangential part with the normal eliminated
  double high = 0, low = 0;  ///< its eigenvalues
  double m1 = 0, m2 = 0;     ///< coupling of normal and tangents in the eigenbasis
  double inverse_normal = 0;  ///< 1 / (W_nn + compliance)
  double slip = -1;  ///< |delta_t| / |lambda_t| of the last local solution that slipped, m/N, where the next search
                     ///< begins; -1: none begins; -1: none
};

struct SweepData {
  const ConstraintProblem* problem;
  const double* w;
  long stride;
  LocalBlock* blocks;
  int block_count;
  /// Exact solution of one block, for cases that the fast formulas do not cover. Writes rows() numbers, N.
  void (*exact)(const ConstraintProblem& problem, int block, const double* lambda, const double* delta, double* out);
};

struct SweepKernels {
  /// Gives each block in order the lambda of its law. Updates lambda and delta, both padded to the stride. Returns the
  /// largest |change of lambda| times W_ii, m.
  double (*sweep)(const SweepData& data, double* lambda, double* delta);
  /// y[0..n) += sum over k of c[k] a[k stride + 0..n), with n a multiple of 8; rows whose c is 0 are not read.
  void (*combine)(double* y, const double* a, long stride, const double* c, int rows, int n);
};

}  // namespace insula
