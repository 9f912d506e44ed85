// SPDX-License-Identifier: GPL-3.0-or-later
// Direct solver of one body's system matrix: multifrontal supernodal Cholesky A = P^T L L^T P on 3x3 blocks. It also
// gives the compliance H A^-1 H^T of sparse rows, by forward substitution on the rows that the elimination tree
// reaches. The factor and everything computed with it has type Real. The outer matrix, vectors and compliance are in
// double. After analyse(), nothing is allocated unless the number of rows exceeds all earlier ones.
#pragma once
#include <array>
#include <utility>
#include <vector>

#include "core/linalg/body_solver.h"
#include "core/linalg/elimination.h"
#include "core/linalg/row_entries.h"

namespace insula {

template <class Real>
class MultifrontalCholesky final : public BodySolver {
 public:
  void analyse(const BlockMatrix& a) override;
  bool factorise(const BlockMatrix& a) override;
  void solve(double* x) override;
  /// With a new matrix the load is substituted front by front, while each front is in the cache.
  bool begin_motion(const BlockMatrix* a, const VecX& load, const VecX& guess) override;
  void unforced_motion(const VecX& load, VecX& x) override;
  void add_free_motion(const BodyRows& rows, double* delta) const override;
  void end_motion(const BodyRows& rows, const double* lambda, VecX& x) override;
  void begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) override;
  int compliance_parts(ComplianceAct act) const override;
  void compliance_part(ComplianceAct act, int part) override;
  void add_compliance(const BodyRows& rows, double* w, int stride) override;
  bool has_second_rows() const override { return true; }
  void exchange_rows() override { std::swap(rows_, second_rows_); }
  SolverCost cost() const override;

  const Elimination& elimination() const { return e_; }
  const Real* panels() const { return panel_.data(); }
  /// x += Y lambda = L^-1 P H^T lambda, permuted order, of the rows in the last begin_compliance().
  void combine(const BodyRows& rows, const double* lambda, Real* x) const;

 private:
  static constexpr int min_part = 32;  ///< smallest number of columns of a part
  static constexpr int lanes =
      64 / int(sizeof(Real));       ///< of the widest vector; leading dimensions are multiples of it
  static constexpr int slack = 64;  ///< kernels read whole vectors

  bool factorise(const BlockMatrix& a, const Front& f);
  void forward(const Front& f, Real* x);
  void add_child(const Front& f, const Front& child);
  bool pivots_are_good(const BlockMatrix& a, const Front& f) const;
  void forward(Real* x);
  void backward(Real* x);

  Elimination e_;
  std::vector<Real> panel_, update_, x_, gathered_;  ///< gathered_: the part of a vector that one front needs
  std::vector<Real> inverse_;                        ///< reciprocals of L's diagonal, permuted order
  std::vector<Real> load_;                           ///< of the step's motion: L^-1 P load
  bool loaded_ = false;

  struct Columns {
    int begin, end;
  };
  /// The rows of the last begin_compliance(), and those of the call before, which are valid as long as the factor is
  /// the same. `order` gives the row of each column of Y (-1: a column of zeros). New rows come first, up to `fresh`;
  /// then those known from before.
  struct RowSet {
    std::vector<Real> y, s;
    std::vector<Real> of_load;  ///< of each column: minus Y^T load_
    std::vector<int> order, begin;
    std::array<std::vector<Columns>, 2> active;  ///< new rows, known rows; for each front
    RowEntries entries;
    long ldy = 0, fresh = 0;
    int columns = 0;
    std::array<std::vector<int>, 2>
        part_begin;  ///< of each act: first new column of each part, then the end of the last part

    std::int64_t rows_factor = -1;  ///< number of the factor
    RowEntries before;
    std::vector<Real> old_y, old_s;
    std::vector<int> old_order, old_column, known;  ///< known: the row's number among the earlier rows, or -1
    std::array<std::vector<Columns>, 2> old_active;
    long old_ldy = 0;
    int reused = 0;
    bool unchanged = false;  ///< all rows are the earlier ones
  };
  void arrange();
  void clear_fresh();
  void copy_known();
  void share_out();
  void forward_columns(int from, int to);
  void product_columns(int from, int to);
  void load_columns(int group, int from, int to);
  void copy_known_products();
  RowSet rows_, second_rows_;
  std::int64_t factor_number_ = 0;
  mutable std::vector<Real> lambda_, products_;  ///< scratch of combine()
  std::vector<int> from_;                        ///< scratch of copy_known()
  std::vector<double> work_;                     ///< scratch of share_out(): flops of each vector of columns
};

extern template class MultifrontalCholesky<double>;
extern template class MultifrontalCholesky<float>;

}  // namespace insula
