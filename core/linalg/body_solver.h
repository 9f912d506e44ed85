// SPDX-License-Identifier: GPL-3.0-or-later
// What solves one body's system A dq = f and gives the compliance of its rows: the seam at which a solver of another kind, or for
// another processor, is put in. A body owns one and knows only this; constraints and collision know nothing of it.
//
// A solver is given a matrix by factorise() and serves it until the next. The rows of begin_compliance() stay those of
// add_compliance(), correct() and the end of the motion until the next begin_compliance(). Nothing is allocated unless more rows come
// than ever before.
//
// A step's motion A^-1 (f + H^T lambda) comes in two halves, with W and lambda between them. The free motion is
// normally used only through the rows. A direct solver that is not asked for it goes through its factor once in each
// direction.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/linalg/block_matrix.h"
#include "core/linalg/body_rows.h"

namespace insula {

/// What a solver's work costs; for reports, budgets and benchmarks.
struct SolverCost {
  std::int64_t factor_entries = 0;  ///< numbers in L, padding not counted
  double factor_flops = 0;          ///< of one factorisation
  double factor_bytes = 0;          ///< read by one solve
  double compliance_flops = 0;      ///< of the last rows' compliance; 0: not counted
};

/// How its last solves went.
struct SolverStatus {
  int age = 0;            ///< steps since the matrix was taken that the factor is of
  int iterations = 0;     ///< most of a solve of the step; 0: direct
  double residual_m = 0;  ///< what was left: most that the preconditioned residual moves a node by, m
  int factors = 0;        ///< taken into use since the start
};

enum class ComplianceAct { forward, product };
constexpr std::array compliance_acts{ComplianceAct::forward, ComplianceAct::product};

class BodySolver {
 public:
  virtual ~BodySolver() = default;
  virtual std::string name() const = 0;
  /// Symbolic work, once per pattern. Throws std::runtime_error (out of memory).
  virtual void analyse(const BlockMatrix& a) = 0;
  /// False when the matrix is not positive definite: the solver is then unusable until a factorise() that succeeds.
  virtual bool factorise(const BlockMatrix& a) = 0;
  /// x := A^-1 x, 3 * nodes values in natural order.
  virtual void solve(double* x) = 0;
  /// First half: takes the load, natural order, N. A solver that is not exact begins at `guess`, m, adds the forces that rows had in the last step
  /// (lagged forces, which motion under them changes less than motion without), and may stop early. What that leaves, correct() makes up for.
  virtual void begin_motion(const VecX& load, const VecX& /*guess*/) {
    free_ = load;
    solve(free_.data());
  }
  /// factorise(), and if that succeeds begin_motion().
  virtual bool factorise_and_begin(const BlockMatrix& a, const VecX& load, const VecX& guess) {
    if (!factorise(a)) return false;
    begin_motion(load, guess);
    return true;
  }
  /// x := A^-1 load, from x, without lagged forces, about as well as the free motion. After begin_motion() of that load.
  virtual void unforced_motion(const VecX& load, VecX& x) {
    x = load;
    solve(x.data());
  }
  /// Adds H dq of the free motion to delta, by row number, of the rows of the last begin_compliance() when its acts are done.
  virtual void add_free_motion(const BodyRows& rows, const std::vector<int>& node_of_block, double* delta) const {
    for (int i = 0; i < rows.count(); ++i)
      for (int e = rows.start[std::size_t(i)]; e < rows.start[std::size_t(i) + 1]; ++e)
        if (const int node = node_of_block[std::size_t(rows.block[std::size_t(e)])]; node >= 0)
          delta[rows.row[std::size_t(i)]] += rows.coeff[std::size_t(e)].dot(free_.segment<3>(3 * node));
  }
  /// Second half: x := A^-1 (load + H^T lambda), natural order; rows and lambda as for correct(), no rows: the free motion.
  virtual void end_motion(const BodyRows& rows, const double* lambda, VecX& x) {
    x = free_;
    if (rows.count() == 0 && exact()) return;
    correction_.resize(x.size());
    correct(rows, lambda, correction_.data());
    x += correction_;
  }
  /// Whether turn() does anything. Rotation of each node from rest, before factorise() of the same step.
  virtual bool wants_rotations() const { return false; }
  virtual void set_rotations(const std::vector<Mat3>& /*rotation*/) {}

  /// H A^-1 H^T of the rows in three acts: set-up, Y = L^-1 H^T, then Y^T Y. The last two come in parts that threads may share; the
  /// bits do not depend on who does which. `node_of_block` maps a row's block to a node of the matrix, -1 for a fixed one.
  virtual void begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) = 0;
  virtual int compliance_parts(ComplianceAct act) const = 0;
  virtual void compliance_part(ComplianceAct act, int part) = 0;
  void compute_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) {
    begin_compliance(rows, node_of_block);
    for (ComplianceAct act : compliance_acts)
      for (int p = 0; p < compliance_parts(act); ++p) compliance_part(act, p);
  }
  /// Adds it into w (row-major, `stride` numbers a row) at the rows' numbers, both triangles.
  virtual void add_compliance(const BodyRows& rows, double* w, int stride) = 0;
  /// Takes off delta (by row number) what lagged forces make of it in the free motion, as far as the compliance knows.
  virtual void subtract_lagged(const BodyRows& /*rows*/, double* /*delta*/) const {}
  /// x := A^-1 H^T lambda, natural order, less what the free motion has of it; lambda is indexed by row number.
  virtual void correct(const BodyRows& rows, const double* lambda, double* x) = 0;

  /// Rows of the last begin_compliance() whose share was known, entries and factor being those of the time before.
  virtual int rows_reused() const { return 0; }
  /// Whether compliance and correct() are of the same matrix. If not, correct() is the truth, and may be called again with
  /// another lambda of the same rows.
  virtual bool exact() const { return true; }
  /// The next factorise() is the first.
  virtual void reset() {}
  /// Whether a solver that works in the background may be waited for, so that the same input gives the same bits.
  virtual void set_deterministic(bool) {}
  virtual SolverStatus status() const { return {}; }
  virtual SolverCost cost() const = 0;

 protected:
  VecX free_;  ///< the free motion, natural order, m, of solvers that know it

 private:
  VecX correction_;
};

}  // namespace insula
