// SPDX-License-Identifier: GPL-3.0-or-later
// A factor's numbers in 16 bits, for solves that need it only nearly: they are bound by memory, and this is half of it.
// A = P^T L D L^T P with L's diagonal 1: whatever rounding (2^-11) does to L, the product stays positive definite.
#pragma once
#include <vector>

#include "core/linalg/block_cholesky.h"
#include "core/linalg/fp16_kernels.h"

namespace insula {

class Fp16Factor {
 public:
  /// Of a factor that has been analysed, and stays while this does.
  explicit Fp16Factor(const MultifrontalCholesky<float>& factor);
  /// Takes over the factor's numbers as they are now.
  void round();
  /// x := A^-1 x, 3 nodes values in natural order.
  void solve(double* x);
  /// x := A^-1 H^T lambda of the factor's last compliance rows, as its correct(), but for this half's rounding.
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
