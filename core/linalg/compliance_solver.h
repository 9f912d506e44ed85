// SPDX-License-Identifier: GPL-3.0-or-later
// The interface of a solver of one symmetric positive definite system A x = f that also gives the compliance
// H A^-1 H^T of sparse rows. It is all that a comparison of solvers needs. What a body's step needs in addition is in
// body_solver.h.
//
// factorise() gives a matrix to a solver, which uses it until the next call. The rows of begin_compliance() are also
// those of add_compliance(), until the next begin_compliance(). Nothing is allocated unless the number of rows exceeds
// all earlier ones.
#pragma once
#include <array>
#include <cstdint>
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
  int rows_reused = 0;              ///< of the last rows: those whose share was known, with the same factor
};

enum class ComplianceAct { forward, product };
constexpr std::array compliance_acts{ComplianceAct::forward, ComplianceAct::product};

class ComplianceSolver {
 public:
  virtual ~ComplianceSolver() = default;
  /// Symbolic work, once per pattern. Throws std::runtime_error (out of memory).
  virtual void analyse(const BlockMatrix& a) = 0;
  /// False when the matrix is not positive definite. The solver is then unusable until a factorise() succeeds.
  virtual bool factorise(const BlockMatrix& a) = 0;
  /// x := A^-1 x, 3 * nodes values in natural order.
  virtual void solve(double* x) = 0;

  /// H A^-1 H^T of the rows in three acts: set-up, Y = L^-1 H^T, then Y^T Y. The last two consist of parts that threads
  /// may share. The bits do not depend on which thread does which part. `node_of_block` maps a row's block to a node of
  /// the matrix, -1 for a fixed one. It must live until the next call.
  virtual void begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) = 0;
  virtual int compliance_parts(ComplianceAct act) const = 0;
  virtual void compliance_part(ComplianceAct act, int part) = 0;
  /// All parts of both acts, on the calling thread.
  void compute_parts() {
    for (ComplianceAct act : compliance_acts)
      for (int p = 0; p < compliance_parts(act); ++p) compliance_part(act, p);
  }
  void compute_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) {
    begin_compliance(rows, node_of_block);
    compute_parts();
  }
  /// Adds the compliance to w (row-major, `stride` numbers a row) at the rows' numbers, both triangles.
  virtual void add_compliance(const BodyRows& rows, double* w, int stride) = 0;

  virtual SolverCost cost() const = 0;
};

}  // namespace insula
