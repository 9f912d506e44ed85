// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices in groups of neighbours, so that one test or one bound serves many.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/math.h"

namespace insula {

/// Orders vertex indices so that every `group` in a row lie near each other: halves by the longest side.
void order_by_position(int* first, int* last, std::span<const Vec3> rest, std::ptrdiff_t group);

/// For each place the group it is in, 0 to groups - 1; groups are of like size.
std::vector<int> group_by_position(std::span<const Vec3> rest, int groups);

}  // namespace insula
