// SPDX-License-Identifier: GPL-3.0-or-later
// A step's problem cut down to what one message carries and the tools feel.
#pragma once
#include "core/constraint/problem.h"

namespace insula {

/// Copies `full` into `small`; with more than most_rows rows, keeps the blocks that touch a tool, then those most coupled
/// to them, in their order. The others hold their solved force: their effect moves into delta_free, so the kept rows have
/// the same solution as long as the tools stand still.
void condense(const ConstraintProblem& full, int most_rows, ConstraintProblem& small);

}  // namespace insula
