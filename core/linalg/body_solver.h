// SPDX-License-Identifier: GPL-3.0-or-later
// The interface of a solver of one body's system A dq = f, which also gives the compliance of its rows. Another solver,
// or one for another processor, is inserted here. A body owns one solver and knows only this interface. Constraints and
// collision do not know it.
//
// factorise() gives a matrix to a solver, which uses it until the next call. The rows of begin_compliance() are also
// those of add_compliance(), correct() and the end of the motion, until the next begin_compliance(). Nothing is
// allocated unless the number of rows exceeds all earlier ones.
//
// A step's motion A^-1 (f + H^T lambda) is computed in two halves, with W and lambda between them. The free motion is
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

/// The cost of a solver's work, for reports, budgets and benchmarks.
struct SolverCost {
  std::int64_t factor_entries = 0;  ///< numbers in L, padding not counted
  double factor_flops = 0;          ///< of one factorisation
  double factor_bytes = 0;          ///< read by one solve
  double compliance_flops = 0;      ///< of the last rows' compliance; 0: not counted
};

/// The state of its last solves.
struct SolverStatus {
  int age = 0;            ///< steps since the matrix of the present factor was taken
  int iterations = 0;     ///< largest number in a solve of the step; 0: direct
  double residual_m = 0;  ///< largest displacement of a node by the preconditioned residual, m
  int factors = 0;        ///< number taken into use since the start
};

enum class ComplianceAct { forward, product };
constexpr std::array compliance_acts{ComplianceAct::forward, ComplianceAct::product};

class BodySolver {
 public:
  virtual ~BodySolver() = default;
  virtual std::string name() const = 0;
  /// Symbolic work, once per pattern. Throws std::runtime_error (out of memory).
  virtual void analyse(const BlockMatrix& a) = 0;
  /// False when the matrix is not positive definite. The solver is then unusable until a factorise() succeeds.
  virtual bool factorise(const BlockMatrix& a) = 0;
  /// x := A^-1 x, 3 * nodes values in natural order.
  virtual void solve(double* x) = 0;
  /// First half: takes the load, natural order, N. An inexact solver begins at `guess`, m. It adds the row forces of
  /// the last step (lagged forces), since motion under them changes less than motion without. It may stop early;
  /// correct() compensates the remaining error.
  virtual void begin_motion(const VecX& load, const VecX& /*guess*/) {
    free_ = load;
    solve(free_.data());
  }
  /// Calls factorise() and, if that succeeds, begin_motion().
  virtual bool factorise_and_begin(const BlockMatrix& a, const VecX& load, const VecX& guess) {
    if (!factorise(a)) return false;
    begin_motion(load, guess);
    return true;
  }
  /// x := A^-1 load without lagged forces, starting from x, about as accurate as the free motion. Call it after
  /// begin_motion() of that load.
  virtual void unforced_motion(const VecX& load, VecX& x) {
    x = load;
    solve(x.data());
  }
  /// Adds H dq of the free motion to delta, by row number. The rows are those of the last begin_compliance(), whose
  /// acts must be done.
  virtual void add_free_motion(const BodyRows& rows, const std::vector<int>& node_of_block, double* delta) const {
    for (int i = 0; i < rows.count(); ++i)
      for (int e = rows.start[std::size_t(i)]; e < rows.start[std::size_t(i) + 1]; ++e)
        if (const int node = node_of_block[std::size_t(rows.block[std::size_t(e)])]; node >= 0)
          delta[rows.row[std::size_t(i)]] += rows.coeff[std::size_t(e)].dot(free_.segment<3>(3 * node));
  }
  /// Second half: x := A^-1 (load + H^T lambda), natural order. Rows and lambda are as for correct(). Without rows it
  /// is the free motion.
  virtual void end_motion(const BodyRows& rows, const double* lambda, VecX& x) {
    x = free_;
    if (rows.count() == 0 && exact()) return;
    correction_.resize(x.size());
    correct(rows, lambda, correction_.data());
    x += correction_;
  }
  /// Whether turn() has an effect. turn() takes the rotation of each node from rest, before factorise() of the same
  /// step.
  virtual bool wants_rotations() const { return false; }
  virtual void set_rotations(const std::vector<Mat3>& /*rotation*/) {}

  /// H A^-1 H^T of the rows in three acts: set-up, Y = L^-1 H^T, then Y^T Y. The last two consist of parts that threads
  /// may share. The bits do not depend on which thread does which part. `node_of_block` maps a row's block to a node of
  /// the matrix, -1 for a fixed one.
  virtual void begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) = 0;
  virtual int compliance_parts(ComplianceAct act) const = 0;
  virtual void compliance_part(ComplianceAct act, int part) = 0;
  void compute_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) {
    begin_compliance(rows, node_of_block);
    for (ComplianceAct act : compliance_acts)
      for (int p = 0; p < compliance_parts(act); ++p) compliance_part(act, p);
  }
  /// Adds the compliance to w (row-major, `stride` numbers a row) at the rows' numbers, both triangles.
  virtual void add_compliance(const BodyRows& rows, double* w, int stride) = 0;
  /// Subtracts the effect of the lagged forces on the free motion from delta (by row number), as far as the compliance
  /// contains it.
  virtual void subtract_lagged(const BodyRows& /*rows*/, double* /*delta*/) const {}
  /// x := A^-1 H^T lambda, natural order, less the part that the free motion contains. lambda is indexed by row number.
  virtual void correct(const BodyRows& rows, const double* lambda, double* x) = 0;

  /// Number of rows of the last begin_compliance() whose share was known. Their entries and the factor were unchanged.
  virtual int rows_reused() const { return 0; }
  /// Whether compliance and correct() belong to the same matrix. If not, correct() is exact, and may be called again
  /// with another lambda of the same rows.
  virtual bool exact() const { return true; }
  /// Drops all history: the next factorise() is treated as the first.
  virtual void reset() {}
  /// Whether the step may wait for a background solver, so that the same input gives the same bits.
  virtual void set_deterministic(bool) {}
  virtual SolverStatus status() const { return {}; }
  virtual SolverCost cost() const = 0;

 protected:
  VecX free_;  ///< the free motion, natural order, m, in solvers that compute it

 private:
  VecX correction_;
};

}  // namespace insula
