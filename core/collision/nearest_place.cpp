// SPDX-License-Identifier: GPL-3.0-or-later
// Every triangle about a place against a piece's core.
#include "core/collision/nearest_place.h"

#include <array>
#include <limits>

#include "core/collision/gjk.h"

namespace insula {

std::optional<Vec3> nearest_place(const RoundedPiece& piece, const Pose& pose, const CollisionMesh& mesh, const std::function<Vec3(int)>& vertex,
                                  const Vec3& about, double within) {
  constexpr double touching_m = 1e-9;  // the core goes through the surface: there is no direction
  std::array<Vec3, 24> points;         // read_tool refuses more
  for (std::size_t i = 0; i < piece.core.size(); ++i) points[i] = pose.apply(piece.core[i]);
  const std::span<const Vec3> core(points.data(), piece.core.size());
  Aabb box;
  box.add(about);
  box.inflate(within);
  double least = std::numeric_limits<double>::infinity();
  std::optional<Vec3> out;
  mesh.tree().overlapping(box, [&](int tri) {
    const auto& v = mesh.triangle(tri);
    const std::array<Vec3, 3> corners{vertex(v[0]), vertex(v[1]), vertex(v[2])};
    const HullDistance d = hull_distance(core, corners);
    if (d.distance >= least || (d.b - about).squaredNorm() > within * within) return;
    least = d.distance;
    out.reset();
    if (d.distance < touching_m) return;
    Vec3 bary = Vec3::Zero();
    for (int k = 0; k < d.count; ++k) bary[d.index[k]] += d.weight[k];
    const Vec3 normal = (d.a - d.b) / d.distance;
    if (normal.dot(mesh.pseudo_normal(tri, feature_of(bary), 1)) >= 0) out = normal;
  });
  return out;
}

}  // namespace insula
