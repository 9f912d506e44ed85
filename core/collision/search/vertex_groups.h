// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices in groups of neighbours, so that one test or one bound covers many.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/math.h"

namespace insula {

/// Orders vertex indices so that every `group` consecutive ones are neighbours. It halves along the longest side.
void order_by_position(int* first, int* last, std::span<const Vec3> rest, std::ptrdiff_t group);

/// The group of each vertex position, 0 to groups - 1; groups have similar sizes.
std::vector<int> group_by_position(std::span<const Vec3> rest, int groups);

}  // namespace insula
