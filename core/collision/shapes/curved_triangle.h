// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle that is curved as the normals at its corners say (Boubekeur, Alexa 2008, Phong Tessellation):
//
//   S(b) = sum_i b_i p_i + sum_k b_k b_(k+1) c_k,   c_k = a ((e . m1) m1 - (e . m0) m0),   e = p_(k+1) - p_k
//
// a = 1 / (g + g^2), with g the cosine of half the angle between the two normals. The middle of an edge between two
// points of a circle then lies on the circle, and the rest to the fourth order of its length. The vector m is the unit
// normal at a corner times the square root of a weight. The weight is 1 where the surface is smooth, and 0 at a sharp
// corner, which leaves it flat there. An edge depends on its own ends alone, so neighbours join without a gap. Scene
// frame, m.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/math.h"

namespace insula {

class CurvedTriangle {
 public:
  CurvedTriangle(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& weighted_normals) : p_(corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &m0 = weighted_normals[k], &m1 = weighted_normals[(k + 1) % 3], e = p_[(k + 1) % 3] - p_[k];
      const double lengths = m0.norm() * m1.norm();
      const double g2 = lengths > 0 ? 0.5 + 0.5 * m0.dot(m1) / lengths : 1, g = std::sqrt(std::max(least_g2, g2));
      c_[k] = (e.dot(m1) * m1 - e.dot(m0) * m0) / (g + g * g);
    }
  }
  Vec3 flat_point(const Vec3& bary) const { return bary[0] * p_[0] + bary[1] * p_[1] + bary[2] * p_[2]; }
  /// From the point of the flat triangle to that of the curved one.
  Vec3 bulge(const Vec3& bary) const {
    return bary[0] * bary[1] * c_[0] + bary[1] * bary[2] * c_[1] + bary[2] * bary[0] * c_[2];
  }
  Vec3 point(const Vec3& bary) const { return flat_point(bary) + bulge(bary); }
  /// Derivative of the point for a change d of bary, with a sum of 0.
  Vec3 derivative(const Vec3& bary, const Vec3& d) const { return flat_point(d) + second_derivative(bary, d); }
  /// Second derivative for changes d and e; it is the same everywhere.
  Vec3 second_derivative(const Vec3& d, const Vec3& e) const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      sum += (d[k] * e[next] + e[k] * d[next]) * c_[std::size_t(k)];
    }
    return sum;
  }

 private:
  static constexpr double least_g2 = 0.5;  ///< normals a right angle apart
  std::array<Vec3, 3> p_, c_;
};

}  // namespace insula
