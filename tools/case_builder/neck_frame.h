// SPDX-License-Identifier: GPL-3.0-or-later
// The line in which a neck's plane cuts the wall, and where it lies when the wall is deformed. Millimetres.
#pragma once
#include <array>
#include <vector>

#include "tools/artery/vessel.h"

namespace insula::case_builder {

/// A point on an edge of the wall: (1 - share) a + share b.
struct EdgePoint {
  int a = 0, b = 0;
  double share = 0;
  Vec3 in(const std::vector<Vec3>& vertices) const {
    return (1 - share) * vertices[std::size_t(a)] + share * vertices[std::size_t(b)];
  }
};
/// Segments of the closed line, of all in which the neck's plane cuts the wall, whose middle is nearest to the neck's.
std::vector<std::array<EdgePoint, 2>> neck_line(const artery::Vessel& vessel);

/// The neck of a wall whose vertices have moved: middle and best plane of the same line.
artery::Neck deformed_neck(const artery::Vessel& at_rest, const std::vector<Vec3>& vertices);

}  // namespace insula::case_builder
