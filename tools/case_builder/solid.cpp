// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/solid.h"

#include <algorithm>
#include <cmath>

#include "core/model/geometry/grid_sample.h"

namespace insula::case_builder {

Solid::Solid(TriMesh mesh) : mesh_(std::move(mesh)), collision_(std::make_unique<CollisionMesh>()) {
  for (const Vec3& p : mesh_.vertices) metres_.push_back(1e-3 * p);
  collision_->build(metres_, mesh_.triangles);
  collision_->update(metres_, {});
}

void Solid::move(std::vector<Vec3> vertices) {
  mesh_.vertices = std::move(vertices);
  for (std::size_t i = 0; i < metres_.size(); ++i) metres_[i] = 1e-3 * mesh_.vertices[i];
  auto fresh = std::make_unique<CollisionMesh>();
  fresh->build(metres_, mesh_.triangles);
  fresh->update(metres_, {});
  collision_ = std::move(fresh);
}

Nearest Solid::nearest(const Vec3& p, double limit) const {
  const NearestPoint n = collision_->nearest(1e-3 * p, 0, 1e-3 * limit);
  if (n.triangle < 0) return {};
  return {true, (n.behind ? -1000 : 1000) * n.distance, n.triangle, n.bary, n.outward};
}

DistanceGrid::DistanceGrid(const Solid& solid, const Vec3& low, const Vec3& high, double step, double limit)
    : low_(low), step_(step), limit_(limit) {
  for (int a = 0; a < 3; ++a) n_[a] = int(std::ceil((high[a] - low[a]) / step)) + 1;
  value_.reserve(std::size_t(n_[0]) * std::size_t(n_[1]) * std::size_t(n_[2]));
  for (int k = 0; k < n_[2]; ++k)
    for (int j = 0; j < n_[1]; ++j)
      for (int i = 0; i < n_[0]; ++i) {
        const Nearest n = solid.nearest(low + step * Vec3(i, j, k), limit);
        value_.push_back(float(n.found ? n.distance : limit));
      }
}

double DistanceGrid::at(const Vec3& p) const { return grid_sample(value_, n_, (p - low_) / step_, limit_); }

}  // namespace insula::case_builder
