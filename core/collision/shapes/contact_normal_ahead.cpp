// SPDX-License-Identifier: GPL-3.0-or-later
// Tests every triangle around a point against a piece's core.
#include "core/collision/shapes/contact_normal_ahead.h"

#include <array>
#include <limits>

#include "core/collision/shapes/gjk.h"

namespace insula {

std::optional<Vec3> contact_normal_ahead(const RoundedPiece& piece, const Pose& pose, const CollisionMesh& mesh,
                                         const std::function<Vec3(int)>& vertex, const Vec3& about, double within,
                                         const Vec3& like) {
  constexpr double touching_m = 1e-9, as_near_m = 0.1e-3;
  constexpr double slack = 0.05;  // a sine: the mesh has the expected positions of the neighbours
  std::array<Vec3, 24> points;    // read_tool refuses more
  for (std::size_t i = 0; i < piece.core.size(); ++i) points[i] = pose.apply(piece.core[i]);
  const std::span<const Vec3> core(points.data(), piece.core.size());
  Aabb box;
  box.add(about);
  box.inflate(within);
  struct Place {
    double distance;
    Vec3 normal;
  };
  std::array<Place, 64> places;  // points nearer than their surroundings
  std::size_t count = 0;
  double least = std::numeric_limits<double>::infinity();
  mesh.tree().overlapping(box, [&](int tri) {
    const auto& v = mesh.triangle(tri);
    const std::array<Vec3, 3> corners{vertex(v[0]), vertex(v[1]), vertex(v[2])};
    const HullDistance d = hull_distance(core, corners);
    if ((d.b - about).squaredNorm() > within * within || count == places.size()) return;
    if (d.distance < touching_m) {
      least = 0;  // the core intersects the surface: there is no direction
      return;
    }
    Vec3 bary = Vec3::Zero();
    for (int k = 0; k < d.count; ++k) bary[d.index[k]] += d.weight[k];
    const Vec3 normal = (d.a - d.b) / d.distance;
    const TriangleFeature feature = feature_of(bary);
    const bool before = normal.dot(mesh.pseudo_normal(tri, feature, 1)) >= 0;
    if (!before) least = std::min(least, d.distance);
    else if (mesh.locally_closest(tri, feature, normal, 1, slack)) places[count++] = {d.distance, normal};
  });
  for (std::size_t i = 0; i < count; ++i) least = std::min(least, places[i].distance);
  std::optional<Vec3> out;
  for (std::size_t i = 0; i < count; ++i)
    if (places[i].distance <= least + as_near_m && (!out || places[i].normal.dot(like) > out->dot(like)))
      out = places[i].normal;
  return out;
}

}  // namespace insula
