// SPDX-License-Identifier: GPL-3.0-or-later
// Where a tool's piece is nearest to a surface that has gone on since it was last detected.
#pragma once
#include <functional>
#include <optional>

#include "core/collision/search/collision_mesh.h"
#include "core/collision/colliders/tool_collider.h"

namespace insula {

/// Of the surface's places no farther than `within` from `about`, the one nearest to the piece's core at this pose: the unit vector from it to
/// the core. Where the core is as near to several, as in a groove: that most along `like`. `vertex`: where the surface's vertices are now, not
/// far from where the mesh has them. Nothing where there is no such place, or the core is not before the surface there. Scene frame, m.
std::optional<Vec3> contact_normal_ahead(const RoundedPiece& piece, const Pose& pose, const CollisionMesh& mesh, const std::function<Vec3(int)>& vertex,
                                  const Vec3& about, double within, const Vec3& like);

}  // namespace insula
