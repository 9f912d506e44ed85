// SPDX-License-Identifier: GPL-3.0-or-later
// Points within edges that are drawn out.
#include "core/collision/colliders/stretched_edges.h"

#include <algorithm>

namespace insula {
namespace {

/// Shares of the edge at which its points lie. The first one, three and seven of them are evenly spaced.
constexpr std::array<double, StretchedEdges::per_edge> shares{0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875};

int points_of(double length2, double limit2) {
  if (length2 <= limit2) return 0;
  if (length2 <= 4 * limit2) return 1;
  return length2 <= 16 * limit2 ? 3 : 7;
}

}  // namespace

StretchedEdges::StretchedEdges(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles)
    : rest_(rest) {
  double sum = 0;
  for (const auto& t : triangles)
    for (int k = 0; k < 3; ++k)
      sum += (rest[std::size_t(t[std::size_t((k + 1) % 3)])] - rest[std::size_t(t[std::size_t(k)])]).norm();
  const double least = triangles.empty() ? 0 : ratio * sum / (3 * double(triangles.size()));
  least2_ = least * least;
}

void StretchedEdges::append_points(const CollisionMesh& mesh, int triangle, std::vector<int>& out) const {
  const auto& v = mesh.triangle(triangle);
  for (int k = 0; k < 3; ++k) {
    const int a = v[std::size_t(k)], b = v[std::size_t((k + 1) % 3)];
    const double length2 = (mesh.vertex(a) - mesh.vertex(b)).squaredNorm();
    if (length2 <= least2_) continue;
    const double rest2 = (rest_[std::size_t(a)] - rest_[std::size_t(b)]).squaredNorm();
    const int count = points_of(length2, std::max(least2_, ratio * ratio * rest2));
    if (count == 0) continue;
    // The first of the edge's triangles numbers its points.
    int owner = triangle, corner = k;
    if (const int other = mesh.across(triangle, k); other >= 0 && other < triangle) {
      const auto& w = mesh.triangle(other);
      owner = other;
      corner = int(std::find(w.begin(), w.end(), b) - w.begin());  // the neighbour has the edge the other way round
    }
    for (int i = 0; i < count; ++i) out.push_back((3 * owner + corner) * per_edge + i);
  }
}

StretchedEdges::Place StretchedEdges::place(int point) {
  const int edge = point / per_edge, corner = edge % 3;
  const double share = shares[std::size_t(point % per_edge)];
  Place at{edge / 3, Vec3::Zero()};
  at.bary[corner] = 1 - share;
  at.bary[(corner + 1) % 3] = share;
  return at;
}

}  // namespace insula
