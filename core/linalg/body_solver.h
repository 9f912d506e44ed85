// SPDX-License-Identifier: GPL-3.0-or-later
// What solves one body's system A dq = f and gives the compliance of its rows: the seam at which a solver of another kind, or for
// another processor, is put in. A body owns one and knows only this; constraints and collision know nothing of it.
//
// A solver is given a matrix by factorise() and serves it until the next. The rows of begin_compliance() stay those of
// add_compliance() and correct() until the next begin_compliance(). Nothing is allocated unless more rows come than ever before.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/linalg/block_matrix.h"
#include "core/mechanics/rows.h"

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
  /// The step's free motion: the same, but a solver that is not exact begins at `guess`, adds the forces that rows had in the last
  /// step (held forces, which motion under them changes less than motion without), and may stop early. What that leaves, correct() makes up for.
  virtual void free_motion(double* x, const double* /*guess*/) { solve(x); }
  /// Whether turn() does anything. Rotation of each node from rest, before factorise() of the same step.
  virtual bool wants_rotations() const { return false; }
  virtual void turn(const std::vector<Mat3>& /*rotation*/) {}

  /// H A^-1 H^T of the rows in three acts: set-up, Y = L^-1 H^T, then Y^T Y. The last two come in parts that threads may share; the
  /// bits do not depend on who does which. `node_of_block` maps a row's block to a node of the matrix, -1 for a held one.
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
  /// x := A^-1 load about as well, from x, without held forces. After free_motion().
  virtual void unforced_motion(const double* /*load*/, double* /*x*/) {}
  /// Takes off delta (by row number) what held forces make of it in the free motion, as far as the compliance knows.
  virtual void take_off_held(const BodyRows& /*rows*/, double* /*delta*/) const {}
  /// x := A^-1 H^T lambda, natural order, less what free_motion() has of it; lambda is indexed by row number.
  virtual void correct(const BodyRows& rows, const double* lambda, double* x) = 0;

  /// Rows of the last begin_compliance() whose share was known, entries and factor being those of the time before.
  virtual int rows_reused() const { return 0; }
  /// Whether compliance and correct() are of the same matrix. If not, correct() is the truth, and may be called again with
  /// another lambda of the same rows.
  virtual bool exact() const { return true; }
  /// The next factorise() is the first.
  virtual void forget() {}
  /// Whether a solver that works in the background may be waited for, so that the same input gives the same bits.
  virtual void may_wait(bool) {}
  virtual SolverStatus status() const { return {}; }
  virtual SolverCost cost() const = 0;
};

}  // namespace insula
