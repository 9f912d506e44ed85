// SPDX-License-Identifier: GPL-3.0-or-later
// Distance grid.
#include "tools/motions/clearance.h"

#include <algorithm>
#include <cmath>

#include "core/collision/shapes/closest.h"
#include "core/model/geometry/grid_sample.h"

namespace insula {

Clearance::Clearance(const Vec3& low, const Vec3& high, double cell) : low_(low), cell_(cell) {
  for (int k = 0; k < 3; ++k) n_[k] = int(std::ceil((high[k] - low[k]) / cell)) + 1;
  clear();
}

void Clearance::clear() {
  const std::size_t n = std::size_t(n_[0]) * std::size_t(n_[1]) * std::size_t(n_[2]);
  distance_.assign(n, float(band));
  side_.assign(n, 0.0f);
}

void Clearance::add(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles) {
  for (const auto& t : triangles) {
    const Vec3 &a = vertices[std::size_t(t[0])], &b = vertices[std::size_t(t[1])], &c = vertices[std::size_t(t[2])];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    const Vec3 lo = a.cwiseMin(b).cwiseMin(c), hi = a.cwiseMax(b).cwiseMax(c);
    int from[3], to[3];
    for (int k = 0; k < 3; ++k) {
      from[k] = std::max(0, int(std::floor((lo[k] - band - low_[k]) / cell_)));
      to[k] = std::min(n_[k] - 1, int(std::ceil((hi[k] + band - low_[k]) / cell_)));
    }
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y)
        for (int x = from[0]; x <= to[0]; ++x) {
          const Vec3 p = low_ + cell_ * Vec3(x, y, z);
          const ClosestPair near = point_triangle(p, a, b, c);
          const double d = std::sqrt(near.distance2);
          const std::size_t i = std::size_t((z * n_[1] + y) * n_[0] + x);
          const double before = std::abs(double(distance_[i])),
                       square = std::abs((p - near.c).dot(normal)) / std::max(d, 1e-12);
          if (d > before + 1e-8 || (d > before - 1e-8 && square <= double(side_[i]))) continue;
          distance_[i] = float((p - near.c).dot(normal) < 0 ? -d : d);
          side_[i] = float(square);
        }
  }
}

double Clearance::at(const Vec3& p) const { return grid_sample(distance_, n_, (p - low_) / cell_, band); }

}  // namespace insula
