// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method over the triangles of a curved surface.
#include "core/collision/colliders/curved_contact.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/collision/search/collision_mesh.h"
#include "core/collision/shapes/curved_triangle.h"
#include "core/collision/shapes/gjk.h"

namespace insula {
namespace {

constexpr int max_steps = 24;
constexpr double converged_m = 1e-11;

CurvedTriangle curved(const CollisionMesh& mesh, int triangle, double t) {
  const auto& v = mesh.triangle(triangle);
  return {{mesh.vertex(v[0], t), mesh.vertex(v[1], t), mesh.vertex(v[2], t)},
          {mesh.weighted_normal(v[0], t), mesh.weighted_normal(v[1], t), mesh.weighted_normal(v[2], t)}};
}

/// The point of the core that is nearest to some point, and how the core goes on there.
struct NearestOfCore {
  Vec3 point;
  Mat3 across = Mat3::Identity();  ///< projection onto what is perpendicular to the vertex, edge or face there
};

NearestOfCore nearest_of(std::span<const Vec3> core, const Vec3& to) {
  NearestOfCore r{core[0], Mat3::Identity()};
  if (core.size() == 1) return r;
  const HullDistance d = hull_distance({&to, 1}, core);
  r.point = d.b;
  if (d.distance < 1e-9) return r;
  for (int k = 1; k < d.count; ++k) {
    const Vec3 along = r.across * (core[std::size_t(d.index[k])] - core[std::size_t(d.index[0])]);
    if (along.norm() > 1e-9) r.across -= along * along.transpose() / along.squaredNorm();
  }
  return r;
}

/// A place on the surface that moves from triangle to triangle.
class Walk {
 public:
  Walk(const CollisionMesh& mesh, double t, int triangle, const Vec3& bary)
      : mesh_(mesh), t_(t), triangle_(triangle), bary_(bary), shape_(curved(mesh, triangle, t)) {}
  int triangle() const { return triangle_; }
  const Vec3& bary() const { return bary_; }
  const CurvedTriangle& shape() const { return shape_; }
  /// Corner opposite the edge that the place has to stay on, since it is nearest from both sides; -1: none.
  int opposite() const { return opposite_; }

  /// Goes by a change of bary, but no farther than the edge of the triangle, and from there into the next one.
  void go(const Vec3& change) {
    double share = 1;
    int hit = -1;
    for (int k = 0; k < 3; ++k)
      if (bary_[k] + change[k] < 0 && bary_[k] < share * -change[k]) {
        share = bary_[k] / -change[k];
        hit = k;
      }
    bary_ += share * change;
    if (hit < 0) {
      from_ = -1;
      return;
    }
    bary_[hit] = 0;
    bary_ = bary_.cwiseMax(0.0);
    bary_ /= bary_.sum();
    cross(hit, share);
  }

 private:
  void cross(int hit, double share) {
    const int next = mesh_.across(triangle_, (hit + 1) % 3);
    if (next < 0 || (next == from_ && share <= 0) || opposite_ >= 0) {
      // A border, or the nearest place of both sides. On an edge already, this is its end.
      opposite_ = opposite_ >= 0 ? opposite_ : hit;
      return;
    }
    const auto &v = mesh_.triangle(triangle_), &w = mesh_.triangle(next);
    Vec3 there = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        if (v[std::size_t(i)] == w[std::size_t(k)]) there[k] = bary_[i];
    from_ = triangle_;
    triangle_ = next;
    bary_ = there / there.sum();
    shape_ = curved(mesh_, triangle_, t_);
  }

  const CollisionMesh& mesh_;
  double t_;
  int triangle_;
  Vec3 bary_;
  CurvedTriangle shape_;
  int from_ = -1;  ///< triangle from which the last change led here
  int opposite_ = -1;
};

/// Change of bary that leads to the smallest distance from the core, by the derivatives at the place.
Vec3 newton_change(const Walk& at, const NearestOfCore& core) {
  const CurvedTriangle& s = at.shape();
  std::array<Vec3, 2> d{Vec3(-1, 1, 0), Vec3(-1, 0, 1)};
  int directions = 2;
  if (const int k = at.opposite(); k >= 0) {
    d[0] = Vec3::Unit((k + 2) % 3) - Vec3::Unit((k + 1) % 3);
    directions = 1;
  }
  const Vec3 r = s.point(at.bary()) - core.point;
  std::array<Vec3, 2> along;
  for (std::size_t i = 0; i < 2; ++i) along[i] = s.derivative(at.bary(), d[i]);
  // The core is taken as endless where it is an edge or a face, unless that leaves no minimum; then as its nearest
  // point, and at last with the surface as flat.
  for (int attempt = 0; attempt < 3; ++attempt) {
    const Mat3 across = attempt == 0 ? core.across : Mat3(Mat3::Identity());
    Eigen::Matrix2d h = Eigen::Matrix2d::Identity();
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
    for (int i = 0; i < directions; ++i) {
      g[i] = along[std::size_t(i)].dot(r);
      for (int k = 0; k < directions; ++k) {
        h(i, k) = along[std::size_t(i)].dot(across * along[std::size_t(k)]);
        if (attempt < 2) h(i, k) += s.second_derivative(d[std::size_t(i)], d[std::size_t(k)]).dot(r);
      }
    }
    const double scale = std::max(along[0].squaredNorm(), along[1].squaredNorm());
    const double least = 1e-3 * scale;
    if (directions == 1 && h(0, 0) > least) return -g[0] / h(0, 0) * d[0];
    if (directions == 2 && h(0, 0) > least && h.determinant() > least * h(0, 0)) {
      const Eigen::Vector2d x = -h.inverse() * g;
      return x[0] * d[0] + x[1] * d[1];
    }
  }
  return Vec3::Zero();
}

}  // namespace

CurvedContact nearest_on_curved(const CollisionMesh& mesh, double t, std::span<const Vec3> core, int triangle,
                                const Vec3& bary) {
  Walk at(mesh, t, triangle, bary);
  NearestOfCore nearest = nearest_of(core, at.shape().point(at.bary()));
  for (int step = 0; step < max_steps; ++step) {
    Vec3 change = newton_change(at, nearest);
    change *= std::min(1.0, 1 / (change.cwiseAbs().maxCoeff() + 1e-300));
    const Vec3 before = at.shape().point(at.bary());
    at.go(change);
    const Vec3 now = at.shape().point(at.bary());
    nearest = nearest_of(core, now);
    if ((now - before).norm() < converged_m && at.shape().flat_point(change).norm() < converged_m) break;
  }
  const CurvedTriangle& s = at.shape();
  const Vec3 out = s.derivative(at.bary(), Vec3(-1, 1, 0)).cross(s.derivative(at.bary(), Vec3(-1, 0, 1))).normalized();
  const Vec3 r = nearest.point - s.point(at.bary());
  const double distance = r.norm();
  const bool behind = r.dot(out) < 0;
  return {at.triangle(), at.bary(), distance < 1e-8 ? out : Vec3((behind ? -r : r) / distance),
          behind ? -distance : distance};
}

Vec3 bulge_at(const CollisionMesh& mesh, double t, int triangle, const Vec3& bary) {
  return curved(mesh, triangle, t).bulge(bary);
}

}  // namespace insula
