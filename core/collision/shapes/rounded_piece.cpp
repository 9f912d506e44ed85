// SPDX-License-Identifier: GPL-3.0-or-later
// Cores and radii of tool pieces, and tool against tool.
#include <Eigen/Eigenvalues>

#include "core/collision/colliders/tool_collider.h"
#include "core/collision/shapes/gjk.h"

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

void detect_tools(const std::vector<RoundedPiece>& a, const Pose& a_start, const Pose& a_free,
                  const std::vector<RoundedPiece>& b, const Pose& b_start, const Pose& b_free,
                  const ToolContactSettings& settings, std::vector<Proximity>& out) {
  const Vec6 da = displacement(a_start, a_free), db = displacement(b_start, b_free);
  std::array<Vec3, 24> pa, pb;
  for (int i = 0; i < int(a.size()); ++i) {
    const RoundedPiece& x = a[std::size_t(i)];
    const Vec3 a0 = a_start.apply(x.axis0), a1 = a_start.apply(x.axis1);
    for (int j = 0; j < int(b.size()); ++j) {
      const RoundedPiece& y = b[std::size_t(j)];
      const Vec3 b0 = b_start.apply(y.axis0), b1 = b_start.apply(y.axis1);
      const auto speed = [](const Vec6& d, const Vec3& p, const Vec3& origin) {
        return (d.head<3>() + d.tail<3>().cross(p - origin)).norm();
      };
      const double motion = std::max(speed(da, a0, a_start.p), speed(da, a1, a_start.p)) +
                            std::max(speed(db, b0, b_start.p), speed(db, b1, b_start.p));
      const double range = settings.alarm + motion;
      double s, t;
      closest_segments(a0, a1, b0, b1, s, t);
      const Vec3 p = a0 + s * (a1 - a0), q = b0 + t * (b1 - b0);
      if ((p - q).norm() > range + x.radius + x.bound + y.radius + y.bound) continue;
      for (std::size_t k = 0; k < x.core.size(); ++k) pa[k] = a_start.apply(x.core[k]);
      for (std::size_t k = 0; k < y.core.size(); ++k) pb[k] = b_start.apply(y.core[k]);
      const HullDistance d = hull_distance({pa.data(), x.core.size()}, {pb.data(), y.core.size()});
      const double gap = d.distance - x.radius - y.radius;
      if (gap > range) continue;
      Vec3 n = d.a - d.b;
      if (d.distance < 1e-9) n = p - q;
      if (n.norm() < 1e-9) n = 0.5 * (a0 + a1 - b0 - b1);
      if (n.norm() < 1e-12) n = Vec3::UnitZ();
      n.normalize();
      Proximity c;
      c.piece = i;
      c.other_piece = j;
      c.normal = n;
      c.point = d.b + n * y.radius;
      c.gap = gap;
      c.start_gap = std::max(gap, -settings.max_correction);
      c.local = a_start.q.conjugate() * (c.point - a_start.p);
      c.other_local = b_start.q.conjugate() * (c.point - b_start.p);
      // Distant pairs count only if the free motion brings them together.
      const Vec3 va = da.head<3>() + da.tail<3>().cross(c.point - a_start.p);
      const Vec3 vb = db.head<3>() + db.tail<3>().cross(c.point - b_start.p);
      if (gap > settings.alarm && gap + n.dot(va - vb) > settings.alarm) continue;
      out.push_back(c);
    }
  }
}

}  // namespace insula
