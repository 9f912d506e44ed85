// SPDX-License-Identifier: GPL-3.0-or-later
// Where a tool's piece is nearest to a surface that has moved since its last detection.
#pragma once
#include <functional>
#include <optional>

#include "core/collision/colliders/tool_collider.h"
#include "core/collision/search/collision_mesh.h"

namespace insula {

/// Of the surface's points that are at most `within` from `about`, takes the one nearest to the piece's core at this
/// pose. Returns the unit vector from it to the core. If several points are equally near, as in a groove, takes the
/// vector most along `like`. `vertex` gives the present positions of the surface's vertices, which are near those of
/// the mesh. Returns nothing if there is no such point, or if the core is not in front of the surface there. Scene
/// frame, m.
std::optional<Vec3> contact_normal_ahead(const RoundedPiece& piece, const Pose& pose, const CollisionMesh& mesh,
                                         const std::function<Vec3(int)>& vertex, const Vec3& about, double within,
                                         const Vec3& like);

}  // namespace insula
