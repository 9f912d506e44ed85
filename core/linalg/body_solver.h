// SPDX-License-Identifier: GPL-3.0-or-later
// The interface of the solver of a body's system A dq = f. A new solver, or one for another processor, implements it.
// A body owns one solver and uses only this interface. Constraints and collision do not use it.
//
// A step's motion A^-1 (f + H^T lambda) is computed in two halves, with W and lambda between them. The free motion is
// normally used only through the rows. A direct solver that is not asked for it goes through its factor once in each
// direction.
#pragma once
#include <vector>

#include "core/linalg/compliance_solver.h"

namespace insula {

class InexactSolver;

class BodySolver : public ComplianceSolver {
 public:
  /// First half: takes the load, natural order, N, and the step's matrix; null keeps the last matrix and its factor.
  /// An inexact solver begins at `guess`, m. False when the matrix is not positive definite.
  virtual bool begin_motion(const BlockMatrix* a, const VecX& load, const VecX& guess) = 0;
  /// x := A^-1 load, about as accurate as the free motion. An inexact solver begins at x and leaves the lagged forces
  /// out. Call it after begin_motion() of that load.
  virtual void unforced_motion(const VecX& load, VecX& x) = 0;
  /// Adds H dq of the free motion to delta, by row number. The rows are those of the last begin_compliance(), and its
  /// acts must be finished.
  virtual void add_free_motion(const BodyRows& rows, double* delta) const = 0;
  /// Second half: x := A^-1 (load + H^T lambda), natural order. The rows are those of the last begin_compliance();
  /// lambda is indexed by row number. Without rows it is the free motion.
  virtual void end_motion(const BodyRows& rows, const double* lambda, VecX& x) = 0;
  /// Whether exchange_rows() works.
  virtual bool has_second_rows() const { return false; }
  /// Exchanges the rows of begin_compliance(), with all that was computed from them, for those of a second set. The
  /// compliance of other rows can thus be computed between two steps without an effect on the step. Exchange them back
  /// before the next step.
  virtual void exchange_rows() {}
  /// This solver if its compliance is not exactly that of the step's matrix, otherwise null.
  virtual InexactSolver* inexact() { return nullptr; }
};

}  // namespace insula
