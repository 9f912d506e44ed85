// SPDX-License-Identifier: GPL-3.0-or-later
// Data of a problem that sweeps need, set up once in each solve.
#pragma once
#include <vector>

#include "core/constraint/problem.h"
#include "core/constraint/sweep_kernels.h"

namespace insula {

/// The kernels for the same instruction set as kernels().
const SweepKernels& sweep_kernels();

/// Data of sweeps beside the problem. set_up() allocates nothing after reserve().
struct SweepMemory {
  std::vector<LocalBlock> blocks;
  void reserve(int rows) { blocks.reserve(std::size_t(rows)); }
  SweepData set_up(const ConstraintProblem& problem);
};

/// The block's lambda that satisfies its law while the other blocks keep theirs. `delta` is that of `lambda`.
void local_solution(const ConstraintProblem& problem, const Block& block, const double* lambda, const double* delta,
                    double* out);

}  // namespace insula
