// SPDX-License-Identifier: GPL-3.0-or-later
// Cores and radii of tool pieces.
#include <Eigen/Eigenvalues>

#include "core/collision/colliders/tool_collider.h"

namespace insula {

RoundedPiece rounded(const ConvexPiece& piece) {
  constexpr double rounding = 2e-4;
  RoundedPiece r;
  r.core = piece.points;
  r.radius = piece.radius;
  if (r.core.empty()) return r;
  constexpr double min_radius = 5e-5;
  if (r.core.size() <= 2) {
    r.radius = std::max(r.radius, min_radius);
    r.axis0 = r.core.front();
    r.axis1 = r.core.back();
    return r;
  }
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : r.core) mean += p;
  mean /= double(r.core.size());
  Mat3 covariance = Mat3::Zero();
  for (const Vec3& p : r.core) covariance += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(covariance);
  const Mat3 axes = solver.eigenvectors().rowwise().reverse();  // longest first
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (const Vec3& p : r.core) {
    const Vec3 x = axes.transpose() * (p - mean);
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  if (r.radius < rounding) {
    const Vec3 size = high - low;
    const double s = std::min(rounding - r.radius, 0.45 * size.minCoeff());
    if (s > 0) {
      const Vec3 middle = 0.5 * (low + high);
      for (Vec3& p : r.core) {
        Vec3 x = axes.transpose() * (p - mean) - middle;
        for (int k = 0; k < 3; ++k) x[k] *= (size[k] - 2 * s) / size[k];
        p = mean + axes * (x + middle);
      }
      low.array() += s;
      high.array() -= s;
      r.radius += s;
    }
  }
  r.radius = std::max(r.radius, min_radius);
  // A segment along the longest axis, shortened by the other two extents.
  const Vec3 middle = 0.5 * (low + high);
  Vec3 end0 = middle, end1 = middle;
  end0[0] = low[0];
  end1[0] = high[0];
  r.axis0 = mean + axes * end0;
  r.axis1 = mean + axes * end1;
  for (const Vec3& p : r.core) {
    const double s = closest_on_segment(p, r.axis0, r.axis1);
    r.bound = std::max(r.bound, (r.axis0 + s * (r.axis1 - r.axis0) - p).norm());
  }
  return r;
}

}  // namespace insula
