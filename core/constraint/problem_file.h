// SPDX-License-Identifier: GPL-3.0-or-later
// A constraint problem as a file, without the tools' terms, for benchmarks and regression tests of the solver.
//
//   8 bytes "INSULAP1"; int32 rows, blocks
//   a block: uint64 id; int32 law (0 box, 1 friction, 2 patch), normals; float64 compliance, lower, upper, friction
//   float64 delta_free[rows] (m), warm start lambda[rows] (N), W's lower half by rows [rows (rows + 1) / 2] (m/N)
// All little-endian.
#pragma once
#include <filesystem>
#include <vector>

#include "core/constraint/problem.h"

namespace insula {

inline constexpr int max_file_rows = 4096;

/// Throws InputError when the file cannot be written.
void write_problem(const std::filesystem::path& file, const ConstraintProblem& problem);
/// Throws InputError with the file's name for anything that is not a sound problem: size, finiteness, signs, laws.
ConstraintProblem read_problem(const std::filesystem::path& file);
/// Names of the problems in a folder (*.problem), sorted. Throws InputError when there is no such folder.
std::vector<std::filesystem::path> problem_files(const std::filesystem::path& folder);

/// Reason why a problem is not sound; empty if it is.
std::string unsound(const ConstraintProblem& problem);

}  // namespace insula
