// SPDX-License-Identifier: GPL-3.0-or-later
// Weights of the hinges' angles in the slope across an edge.
#include "plugins/membrane/slope.h"

#include <Eigen/SVD>
#include <cmath>

namespace insula {
namespace {

using Vec2 = Eigen::Vector2d;

/// Weight of the outer hinges relative to the edge's own hinge.
constexpr double outer = 0.3;
/// Combinations of quadratics with a smaller singular value than this, relative to the largest, are dropped.
constexpr double min_singular = 0.02;

/// Position of a triangle's apex in a plane in which its edge (p, q) is at (p2, q2). The apex is on the left of p2 to
/// q2 or on the right.
Vec2 unfold(const Vec3& p, const Vec3& q, const Vec3& apex, const Vec2& p2, const Vec2& q2, double side) {
  const Vec3 e = q - p, a = apex - p;
  const double length = e.norm(), along = e.dot(a) / length, across = e.cross(a).norm() / length;
  const Vec2 d = (q2 - p2) / length;
  return p2 + along * d + side * across * Vec2(-d.y(), d.x());
}

/// Rise of a deflection at the apex above the plane's value on the edge, over the apex's height.
double rise(const double edge1, const double edge2, const double at_apex, const Vec2& p, const Vec2& q,
            const Vec2& apex) {
  const Vec2 e = q - p, a = apex - p;
  const double s = e.dot(a) / e.squaredNorm(), height = std::abs(e.x() * a.y() - e.y() * a.x()) / e.norm();
  return (at_apex - (1 - s) * edge1 - s * edge2) / height;
}

Vec3 quadratics(const Vec2& x) { return {x.x() * x.x(), x.x() * x.y(), x.y() * x.y()}; }

/// Jump of slope over an unfolded hinge for the three quadratics.
Vec3 jump(const Vec2& p, const Vec2& q, const Vec2& a, const Vec2& b) {
  const Vec3 fp = quadratics(p), fq = quadratics(q), fa = quadratics(a), fb = quadratics(b);
  Vec3 out;
  for (int k = 0; k < 3; ++k) out[k] = rise(fp[k], fq[k], fa[k], p, q, a) + rise(fp[k], fq[k], fb[k], p, q, b);
  return out;
}

}  // namespace

SlopeWeights slope_weights(const WallTopology& wall, const std::vector<Vec3>& rest, int hinge) {
  const WallHinge& h = wall.hinges[std::size_t(hinge)];
  const auto at = [&](int node) -> const Vec3& { return rest[std::size_t(node)]; };
  // Lengths in units of the edge; the middle of the edge is the origin. The first triangle is on the left.
  const double length = (at(h.node[1]) - at(h.node[0])).norm();
  const Vec2 p(-0.5 * length, 0), q(0.5 * length, 0);
  const Vec2 a = unfold(at(h.node[0]), at(h.node[1]), at(h.node[2]), p, q, 1) / length;
  const Vec2 b = unfold(at(h.node[0]), at(h.node[1]), at(h.node[3]), p, q, -1) / length;
  const Vec2 p1 = p / length, q1 = q / length;

  SlopeWeights w;
  Eigen::Matrix<double, 3, 5> m = Eigen::Matrix<double, 3, 5>::Zero();
  w.hinge[0] = hinge;
  m.col(0) = jump(p1, q1, a, b);
  w.count = 1;
  for (int s = 0; s < 2; ++s) {
    const WallTopology::Side side = wall.sides[std::size_t(hinge)][std::size_t(s)];
    const auto& corners = wall.triangles[std::size_t(side.triangle)];
    const Vec2 flat[3] = {s == 0 ? p1 : q1, s == 0 ? q1 : p1, s == 0 ? a : b};  // corners from the edge on
    for (int k = 1; k <= 2; ++k) {
      const int edge = (side.edge + k) % 3, next = wall.hinge_of[std::size_t(side.triangle)][std::size_t(edge)];
      if (next < 0) continue;
      const WallHinge& n = wall.hinges[std::size_t(next)];
      const bool first = wall.sides[std::size_t(next)][0].triangle == side.triangle;
      const Vec3 &from = at(corners[std::size_t(edge)]), &to = at(corners[std::size_t((edge + 1) % 3)]);
      const Vec2 from2 = flat[k], to2 = flat[(k + 1) % 3];
      const Vec2 apex2 = unfold(from, to, at(n.node[first ? 3 : 2]), from2 * length, to2 * length, -1) / length;
      w.hinge[w.count] = next;
      m.col(w.count++) = jump(from2, to2, flat[(k + 2) % 3], apex2);
    }
  }
  // The slope relative to the first triangle is zero at the middle of the edge for each of the quadratics.
  const Vec3 fp = quadratics(p1), fq = quadratics(q1), fa = quadratics(a);
  Vec3 wanted;
  for (int k = 0; k < 3; ++k) wanted[k] = rise(fp[k], fq[k], fa[k], p1, q1, a);
  const double two = a.y() / (a.y() - b.y());
  wanted -= two * m.col(0);
  Eigen::Matrix<double, 3, 5> scaled = outer * m;
  scaled.col(0) = m.col(0);
  Eigen::JacobiSVD<Eigen::Matrix<double, 3, 5>, Eigen::FullPivHouseholderQRPreconditioner> svd(
      scaled, Eigen::ComputeFullU | Eigen::ComputeFullV);
  svd.setThreshold(min_singular);
  const Eigen::Matrix<double, 5, 1> more = svd.solve(wanted);
  for (int k = 0; k < w.count; ++k) w.weight[k] = (k == 0 ? 1 : outer) * more[k];
  w.weight[0] += two;
  return w;
}

}  // namespace insula
