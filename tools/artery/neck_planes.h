// SPDX-License-Identifier: GPL-3.0-or-later
// What a plane parts from a vessel's wall.
#pragma once
#include "import_parts.h"

namespace insula::artery {

inline constexpr std::size_t min_sac_vertices = 12;

inline double height(const Vec3& p, const NeckPlane& plane) { return (p - plane.centre).dot(plane.normal); }

/// The closed line in which a plane cuts the border of a connected set of vertices: its centre and area.
struct Loop {
  Vec3 centre = Vec3::Zero();
  double area = 0;
};

/// The piece beyond the plane that the loop nearest to its centre belongs to. next: the neighbours of each vertex.
std::vector<int> dome_beyond(const TriMesh& mesh, const std::vector<std::vector<int>>& next, const NeckPlane& plane,
                             Loop& loop);
/// Whether a vertex of the set belongs to a cap.
bool holds_a_cap(const Surface& surface, const std::vector<int>& set);

}  // namespace insula::artery
