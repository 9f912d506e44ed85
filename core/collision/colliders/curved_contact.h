// SPDX-License-Identifier: GPL-3.0-or-later
// The point of a curved surface that is nearest to a convex core.
//
// Contacts with the flat triangles of a round surface change direction from triangle to triangle, and their gap has the
// height of the facets. On the curved surface (core/collision/shapes/curved_triangle.h) the gap is the distance of the
// core from a surface without edges, and the normal is the gradient of that gap. So a closed path without friction does
// no work.
#pragma once
#include <span>

#include "core/base/math.h"

namespace insula {

class CollisionMesh;

struct CurvedContact {
  int triangle = -1;
  Vec3 bary = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< unit, from the surface to the core
  double distance = 0;          ///< m, negative behind the surface
};

/// Starts from a point of a flat triangle at time t of the step and goes to the nearest minimum, across edges. Newton's
/// method; stops after a fixed number of steps with what it has. `core` has at least one point.
CurvedContact nearest_on_curved(const CollisionMesh& mesh, double t, std::span<const Vec3> core, int triangle,
                                const Vec3& bary);

/// From the point of the flat triangle to the curved surface, m.
Vec3 bulge_at(const CollisionMesh& mesh, double t, int triangle, const Vec3& bary);

}  // namespace insula
