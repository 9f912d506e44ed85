// SPDX-License-Identifier: GPL-3.0-or-later
// What a sweep needs of a problem, set up once a solve.
#pragma once
#include <vector>

#include "core/constraint/problem.h"
#include "core/constraint/sweep_kernels.h"

namespace insula {

/// Of the same instruction set as kernels().
const SweepKernels& sweep_kernels();

/// What a sweep needs beside the problem; nothing is allocated in set_up() after reserve().
struct SweepMemory {
  std::vector<LocalBlock> blocks;
  void reserve(int rows) { blocks.reserve(std::size_t(rows)); }
  SweepData set_up(const ConstraintProblem& problem);
};

/// The block's lambda that satisfies its law while the other blocks keep theirs; delta belongs to lambda.
void local_solution(const ConstraintProblem& problem, const Block& block, const double* lambda, const double* delta,
                    double* out);

}  // namespace insula
