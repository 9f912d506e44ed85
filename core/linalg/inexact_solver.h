// SPDX-License-Identifier: GPL-3.0-or-later
// A solver whose compliance belongs to an older matrix than the step's. Its free motion is that under the row forces of
// the last step (lagged forces), since motion under them changes less than motion without. It may stop early; the
// second half of the motion compensates the remaining error. Defect correction removes the error of the compliance
// (core/sim/defect_correction.h).
#pragma once
#include <vector>

#include "core/linalg/body_solver.h"

namespace insula {

/// The state of its last solves.
struct SolverStatus {
  int age = 0;            ///< steps since the matrix of the present factor was taken
  int iterations = 0;     ///< largest number in a solve of the step; 0: direct
  double residual_m = 0;  ///< largest displacement of a node by the preconditioned residual, m
  int factors = 0;        ///< number taken into use since the start
};

/// When a step takes the factor that the background was asked for.
enum class FactorTiming {
  counted,     ///< a number of steps after the request; the step may wait for it, so the same input gives the same bits
  when_ready,  ///< the first step that finds it ready; no step waits
  told         ///< the step before which take_next() was called; it may wait. For the repetition of a recorded run.
};

class InexactSolver : public BodySolver {
 public:
  /// The rotation of each node from rest, before the matrix of the same step.
  virtual void set_rotations(const std::vector<Mat3>& rotation) = 0;
  /// Subtracts the effect of the lagged forces on the free motion from delta (by row number), as far as the compliance
  /// contains it.
  virtual void subtract_lagged(const BodyRows& rows, double* delta) const = 0;
  /// x = A^-1 H^T lambda, natural order, less the part that the free motion contains, with the step's own matrix. The
  /// rows are those of the last begin_compliance(); lambda is indexed by row number. It may be called again with
  /// another lambda. The result is valid until the next call of a function that is not const.
  virtual const std::vector<double>& correct(const BodyRows& rows, const double* lambda) = 0;
  /// Adds H x of the last correct() to delta, by row number.
  virtual void add_correction(const BodyRows& rows, double* delta) const = 0;
  /// Drops all history: the next matrix is treated as the first.
  virtual void reset() = 0;
  virtual void set_timing(FactorTiming timing) = 0;  ///< default: counted
  /// The coming step takes the requested factor.
  virtual void take_next() = 0;
  /// Whether the last step took an answer of the background, be it a factor or a failure.
  virtual bool took() const = 0;
  virtual SolverStatus status() const = 0;

  InexactSolver* inexact() override { return this; }
};

}  // namespace insula
