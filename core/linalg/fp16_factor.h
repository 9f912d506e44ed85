// SPDX-License-Identifier: GPL-3.0-or-later
// A factor's numbers in 16 bits, for approximate solves. These are bound by memory bandwidth, and 16 bits halve the
// traffic. A = P^T L D L^T P with the diagonal of L equal to 1. The rounding of L (2^-11) therefore leaves the product
// positive definite.
#pragma once
#include <vector>

#include "core/linalg/block_cholesky.h"
#include "core/linalg/fp16_kernels.h"

namespace insula {

class Fp16Factor {
 public:
  /// Uses a factor that has been analysed and that outlives this object.
  explicit Fp16Factor(const MultifrontalCholesky<float>& factor);
  /// Copies the factor's present numbers.
  void round();
  /// x := A^-1 x, 3 nodes values in natural order.
  void solve(double* x);
  /// x := A^-1 H^T lambda for the factor's last compliance rows. The first half has the factor's precision, the second
  /// half 16 bits.
  void correct(const BodyRows& rows, const double* lambda, double* x);

 private:
  void forward();
  void backward();

  const MultifrontalCholesky<float>* factor_;
  std::vector<Half> stream_;
  std::vector<float> inverse_root_;  ///< of D
  std::vector<float> x_, front_, block_;
};

}  // namespace insula
