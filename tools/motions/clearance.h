// SPDX-License-Identifier: GPL-3.0-or-later
// How far places are from surfaces: signed distances on a grid, filled triangle by triangle within a band.
#pragma once
#include <vector>

#include "core/model/mesh.h"

namespace insula {

class Clearance {
 public:
  static constexpr double band = 1.6e-3;  ///< m; places farther away, and outside the box, are `band` away

  Clearance(const Vec3& low, const Vec3& high, double cell);
  void clear();
  /// Triangles counter-clockwise from outside; behind them distances are negative.
  void add(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles);
  double at(const Vec3& p) const;

 private:
  Vec3 low_;
  double cell_;
  int n_[3];
  std::vector<float> distance_, side_;  ///< signed; how squarely the nearest triangle is met, to break ties at edges
};

}  // namespace insula
