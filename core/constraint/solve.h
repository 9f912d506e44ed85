// SPDX-License-Identifier: GPL-3.0-or-later
// Solver of the mixed nonlinear complementarity problem: block Gauss-Seidel, and nonsmooth Newton where that stalls. It
// is pure and bounded. The result depends only on the arguments, and the work is at most max_sweeps sweeps and
// max_newton Newton steps. It allocates nothing once the workspace has its size.
#pragma once
#include <limits>
#include <span>
#include <vector>

#include "core/constraint/newton.h"
#include "core/constraint/problem.h"
#include "core/constraint/sweep.h"

namespace insula {

struct SolveSettings {
  int max_sweeps = 200;
  /// Stop when no lambda of a sweep would move its row by more than this (metres): |W_ii * change| <= tolerance.
  double tolerance_m = 1e-9;
  /// Extrapolates lambda along conjugate directions between sweeps. This helps in stiff stacks, such as jaws on a thin
  /// wall.
  bool conjugate = false;
  /// Largest number of Newton steps, which are made when sweeps would end above the tolerance; 0: only sweeps. One step
  /// costs as much as rows / 3 sweeps.
  int max_newton = 0;
  bool newton_soon = false;  ///< start Newton after a few sweeps, for problems that are known to stall
  int newton_unknowns = std::numeric_limits<int>::max();  ///< largest number of rows that neither separate nor lie at a
                                                          ///< bound in a Newton step
  int newton_sweeps =
      32;  ///< conjugate sweeps before another attempt, after a step without success; 0: no further attempt
  /// A Newton step to a larger value of lambda is not taken. Where rows depend on one another, W has a null space. A
  /// step along it changes no delta, so the residual does not see it, however large the forces become.
  double newton_bound = std::numeric_limits<double>::infinity();
};

enum class SolveMethod : std::uint8_t { sweeps, newton };

struct SolveStats {
  int sweeps = 0;
  double residual_m = 0;  ///< largest violation of a law over all rows, m (natural map scaled by 1/W_ii)
  double residual_N = 0;  ///< the same in newtons
  bool stalled = false;   ///< sweeps did not reach the tolerance, and Newton was asked for
  int newton_steps = 0;   ///< number of steps tried, in addition to the sweeps
  SolveMethod method = SolveMethod::sweeps;  ///< newton: the result is better than that of the sweeps alone
};

/// All memory that solve writes. Each caller has one. It grows only in reserve().
struct SolveWorkspace {
  std::vector<double> lambda;                                    ///< in: warm start, out: solution; N
  std::vector<double> delta;                                     ///< out: W lambda + delta_free, m
  std::vector<double> before, before_delta, along, along_delta;  ///< of the conjugate directions
  AlignedVector<double> current;                                 ///< delta while it is being solved for, padded
  SweepMemory sweep;
  NewtonMemory newton;
  void reserve(int rows, bool with_newton = true);
};

/// delta := W lambda + free, m; padded to the problem's stride.
void full_delta(const ConstraintProblem& problem, std::span<const double> free, const double* lambda,
                AlignedVector<double>& delta);

/// Solves with the given delta_free (problem.rows values; the problem's own or the servo's). workspace.lambda must hold
/// the warm start (problem.rows values). Never allocates if workspace.reserve(rows) was called.
SolveStats solve(const ConstraintProblem& problem, std::span<const double> delta_free, const SolveSettings& settings,
                 SolveWorkspace& workspace);

}  // namespace insula
