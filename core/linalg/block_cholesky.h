// SPDX-License-Identifier: GPL-3.0-or-later
// Direct solver of one body's system matrix: multifrontal supernodal Cholesky A = P^T L L^T P on 3x3 blocks, and the
// compliance H A^-1 H^T of sparse rows by forward substitution on the rows that the elimination tree reaches.
// The factor and all that is made with it is in Real; matrix, vectors and compliance outside are in double.
// Everything after analyse() allocates nothing unless the number of rows grows past what was seen.
#pragma once
#include <vector>

#include "core/linalg/body_solver.h"
#include "core/linalg/elimination.h"

namespace insula {

template <class Real>
class MultifrontalCholesky final : public BodySolver {
 public:
  std::string name() const override { return sizeof(Real) == 4 ? "direct, single precision" : "direct"; }
  void analyse(const BlockMatrix& a) override;
  bool factorise(const BlockMatrix& a) override;
  void solve(double* x) override;
  void begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) override;
  int compliance_parts() const override { return columns_ >= 2 * least_part ? most_parts : columns_ > 0 && e_.nodes > 0 ? 1 : 0; }
  void compliance_part(int part) override;
  void end_compliance() override;
  void add_compliance(const BodyRows& rows, double* w, int stride) const override;
  void correct(const BodyRows& rows, const double* lambda, double* x) override;
  SolverCost cost() const override { return {e_.entries, e_.flops, 2.0 * sizeof(Real) * double(e_.entries)}; }
  int supernodes() const { return int(e_.front.size()); }

 private:
  static constexpr int most_parts = 4, least_part = 32;   ///< parts; columns that are worth one
  static constexpr int lanes = 64 / int(sizeof(Real));    ///< of the widest vector; what leading dimensions are multiples of
  static constexpr int slack = 64;                        ///< kernels read whole vectors

  bool factorise(const BlockMatrix& a, const Front& f);
  void add_child(const Front& f, const Front& child);
  bool pivots_are_good(const BlockMatrix& a, const Front& f) const;
  void forward(Real* x);
  void backward(Real* x);
  void store(double* x) const;  ///< x_, in natural order

  Elimination e_;
  std::vector<Real> panel_, update_, x_, below_;  ///< below_: of one front, gathered

  // Rows in flight.
  std::vector<Real> y_, s_, lambda_;
  std::vector<int> order_, begin_, active_lo_, active_hi_;
  long ldy_ = 0;
  int columns_ = 0;
};

extern template class MultifrontalCholesky<double>;
extern template class MultifrontalCholesky<float>;
using BlockCholesky = MultifrontalCholesky<double>;

}  // namespace insula
