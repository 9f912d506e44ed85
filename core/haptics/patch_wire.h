// SPDX-License-Identifier: GPL-3.0-or-later
// Surface patches in a haptic_problem_t message.
#pragma once
#include <array>

#include "core/bus/byte_io.h"
#include "core/constraint/surface_patch.h"

namespace insula::wire {

struct ProblemLayout;

bool patches_fit(const SurfacePatches& patches);
/// `tool_number`: number in the message of each of the problem's tools, -1: it is left out, and its patches with it.
void write_patches(ByteWriter& out, const SurfacePatches& patches, const std::array<int, 2>& tool_number);
/// Moves `in` behind the patches. False if their sizes do not fit.
bool skip_patches(ByteReader& in);
/// Whether the patches are finite, in range, and consistent with rows, blocks and tools.
bool plausible_patches(const ProblemLayout& layout, const char*& why);
/// Reads patches that are plausible. Allocates only when `into` must grow.
void read_patches(const ProblemLayout& layout, SurfacePatches& into);

}  // namespace insula::wire
