// SPDX-License-Identifier: GPL-3.0-or-later
// The reduced dynamic model in a haptic_problem_t message.
#pragma once
#include "core/bus/byte_io.h"
#include "core/constraint/reduced_model.h"

namespace insula::wire {

struct ProblemLayout;

bool reduced_model_fits(const ReducedModel& model, int rows);
void write_reduced_model(ByteWriter& out, const ReducedModel& model, int rows);
/// Moves `in` behind the model. False if its sizes do not fit.
bool skip_reduced_model(ByteReader& in, int rows);
/// Whether the model is finite and in range, and passive: no mass, damping or stiffness is negative, and no row moves
/// more by the modes than W says.
bool plausible_reduced_model(const ProblemLayout& layout, const char*& why);
/// Reads a model that is plausible. Allocates only when `into` must grow.
void read_reduced_model(const ProblemLayout& layout, ReducedModel& into);

}  // namespace insula::wire
