// SPDX-License-Identifier: GPL-3.0-or-later
// A bilinear patch between two straight lines: its points, and the foot of a point on it.
//
//   x(s, t) = (1-s)(1-t) c0 + (1-s) t c1 + s (1-t) c2 + s t c3
//
// s leads across, from the line c0 c1 to the line c2 c3. t leads along the lines. Lengths in metres.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/math.h"

namespace insula {

struct BilinearPatch {
  std::array<Vec3, 4> corner;

  struct Foot {
    double s = 0.5, t = 0.5;
    Vec3 at = Vec3::Zero();
    Vec3 normal = Vec3::Zero();  ///< unit, along dx/ds x dx/dt
    double height = 0;           ///< of the point above the patch, along `normal`
  };

  static std::array<double, 4> weights(double s, double t) {
    return {(1 - s) * (1 - t), (1 - s) * t, s * (1 - t), s * t};
  }
  Vec3 at(double s, double t) const {
    const std::array<double, 4> w = weights(s, t);
    return w[0] * corner[0] + w[1] * corner[1] + w[2] * corner[2] + w[3] * corner[3];
  }
  /// Unit, along dx/ds x dx/dt.
  Vec3 normal(double s, double t) const {
    return (corner[2] - corner[0] + t * twist()).cross(corner[1] - corner[0] + s * twist()).normalized();
  }
  Vec3 middle() const { return at(0.5, 0.5); }
  /// Of the ball about the middle that holds the patch.
  double radius() const {
    double out = 0;
    for (const Vec3& c : corner) out = std::max(out, (c - middle()).norm());
    return out;
  }

  /// The point of the patch, continued beyond its edges, whose distance to p is stationary: p = at + height normal.
  /// False where Newton's method finds none near the patch. It never allocates.
  bool foot(const Vec3& p, Foot& out) const {
    const Vec3 twisted = twist();
    double s = 0.5, t = 0.5;
    for (int i = 0; i < 20; ++i) {
      const Vec3 ds = corner[2] - corner[0] + t * twisted, dt = corner[1] - corner[0] + s * twisted;
      const Vec3 gap = p - at(s, t);
      // Gradient and Hessian of |gap|^2 / 2.
      const double gs = -gap.dot(ds), gt = -gap.dot(dt);
      const double ss = ds.squaredNorm(), st = ds.dot(dt) - gap.dot(twisted), tt = dt.squaredNorm();
      const double det = ss * tt - st * st;
      if (!(det > 1e-6 * ss * tt)) return false;
      const double step_s = (st * gt - tt * gs) / det, step_t = (st * gs - ss * gt) / det;
      s += step_s;
      t += step_t;
      if (!(std::abs(s - 0.5) < 2 && std::abs(t - 0.5) < 2)) return false;
      if (std::abs(step_s) + std::abs(step_t) > 1e-13) continue;
      out.s = s;
      out.t = t;
      out.at = at(s, t);
      out.normal = normal(s, t);
      out.height = (p - out.at).dot(out.normal);
      return true;
    }
    return false;
  }

  /// A cheap bound: how far the patch is at least from points beside it.
  class Slab {
   public:
    explicit Slab(const BilinearPatch& patch)
        : middle_(patch.middle()), normal_(patch.normal(0.5, 0.5)), depth_(patch.twist().norm() / 4) {
      // A strongly twisted patch has no side.
      for (const double s : {0.0, 1.0})
        for (const double t : {0.0, 1.0})
          if (!(patch.normal(s, t).dot(normal_) > 0)) depth_ = std::numeric_limits<double>::infinity();
    }
    /// A foot of p within the patch has at least this height, in the direction of the normal (sign 1) or against it
    /// (sign -1). Minus infinity: unknown.
    double least_height(const Vec3& p, int sign) const {
      const double height = sign * (p - middle_).dot(normal_) - depth_;
      return height > 0 ? height : -std::numeric_limits<double>::infinity();
    }
    /// A foot of p within the patch is at least so far away.
    double least_distance(const Vec3& p) const { return std::max(0.0, std::abs((p - middle_).dot(normal_)) - depth_); }

   private:
    Vec3 middle_, normal_;
    double depth_;  ///< half of the thickness of the slab that holds the patch, m
  };

 private:
  Vec3 twist() const { return corner[0] - corner[1] - corner[2] + corner[3]; }  ///< d2x / ds dt
};

}  // namespace insula
