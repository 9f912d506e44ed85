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

  /// The point of the patch, continued beyond its edges, whose distance to p is stationary: p = at + height normal.
  /// False where Newton's method finds none near the patch. It never allocates.
  bool foot(const Vec3& p, Foot& out) const {
    if (!foot_parameters(p, out.s, out.t)) return false;
    complete(p, out);
    return true;
  }
  /// The same, but only s and t.
  bool foot_parameters(const Vec3& p, double& s, double& t) const {
    const Vec3 twisted = twist();
    s = t = 0.5;
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
      if (std::abs(step_s) + std::abs(step_t) < 1e-9) return true;  // the next step would be its square
    }
    return false;
  }
  /// Place, normal and height of the foot with out.s and out.t.
  void complete(const Vec3& p, Foot& out) const {
    out.at = at(out.s, out.t);
    out.normal = normal(out.s, out.t);
    out.height = (p - out.at).dot(out.normal);
  }

  /// Cheap bounds of where a point has its foot: a box about the patch, and how far normals turn. Before normalisation
  /// the normal is affine in s and t, so all normals lie within the cone about the middle one that holds those of the
  /// corners.
  class Bounds {
   public:
    explicit Bounds(const BilinearPatch& patch)
        : middle_(patch.middle()), normal_(patch.normal(0.5, 0.5)), depth_(patch.twist().norm() / 4) {
      const Vec3 dt = patch.corner[1] + patch.corner[3] - patch.corner[0] - patch.corner[2];
      axes_.row(0) = normal_;
      axes_.row(1) = normal_.cross(dt).normalized();
      axes_.row(2) = dt.normalized();
      for (const Vec3& c : patch.corner) {
        radius_ = std::max(radius_, (c - middle_).norm());
        half_ = half_.cwiseMax((axes_ * (c - middle_)).cwiseAbs());
      }
      for (const double s : {0.0, 1.0})
        for (const double t : {0.0, 1.0}) cosine_ = std::min(cosine_, patch.normal(s, t).dot(normal_));
      has_side_ = cosine_ > 0;
      sine_ = has_side_ ? std::sqrt(std::max(0.0, 1 - cosine_ * cosine_)) : 1;
      if (!has_side_) depth_ = std::numeric_limits<double>::infinity();
    }
    /// The distance between a ball about p and the ball that holds the patch; negative where they overlap.
    double gap(const Vec3& p, double radius) const { return (p - middle_).norm() - radius_ - radius; }
    /// False if no point of a ball about p has a foot within the patch that is nearer than `most`.
    bool may_have_foot(const Vec3& p, double radius, double most) const {
      const Vec3 outside = ((axes_ * (p - middle_)).cwiseAbs() - half_).cwiseMax(0);
      if (outside.squaredNorm() > (most + radius) * (most + radius)) return false;
      if (!has_side_) return true;
      // The foot's distance is along its normal, so it is at most that far beside the patch.
      const double aside = radius + sine_ * std::min(most, (outside[0] + 2 * half_[0] + radius) / cosine_);
      return outside[1] <= aside && outside[2] <= aside;
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
    Mat3 axes_;                     ///< of the box, orthonormal rows, the normal first
    Vec3 half_ = Vec3::Zero();      ///< half of its extent along them, m
    double radius_ = 0;             ///< of the ball about the middle that holds the patch, m
    double depth_;                  ///< half of the thickness of the slab that holds the patch, m
    double cosine_ = 1, sine_ = 0;  ///< of the largest angle between a normal and the middle one
    bool has_side_ = true;          ///< false for a strongly twisted patch
  };

 private:
  Vec3 twist() const { return corner[0] - corner[1] - corner[2] + corner[3]; }  ///< d2x / ds dt
};

}  // namespace insula
