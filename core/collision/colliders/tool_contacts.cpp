// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts of a tool's piece with a surface at one moment of the step.
#include <array>
#include <cmath>

#include "core/collision/shapes/gjk.h"
#include "core/collision/shapes/placed_piece.h"

namespace insula {
namespace {

struct Narrow {
  double distance = 0;  ///< of the core, unsigned
  Vec3 p, c, bary;
};

// Exact up to `limit`. Beyond, the result is a lower bound of the distance.
Narrow closest(std::span<const Vec3> core, const std::array<Vec3, 3>& tri, double limit) {
  Narrow r;
  if (core.size() <= 2) {
    const ClosestPair q = core.size() == 1 ? point_triangle(core[0], tri[0], tri[1], tri[2])
                                           : segment_triangle(core[0], core[1], tri[0], tri[1], tri[2]);
    r.distance = std::sqrt(q.distance2);
    r.p = q.p;
    r.c = q.c;
    r.bary = q.bary;
    return r;
  }
  const HullDistance d = hull_distance(core, tri, limit);
  r.distance = d.distance;
  r.p = d.a;
  r.c = d.b;
  r.bary.setZero();
  for (int k = 0; k < d.count; ++k) r.bary[d.index[k]] += d.weight[k];
  return r;
}

bool above(const Vec3& q, const std::array<Vec3, 3>& t, const Vec3& n, Vec3& bary) {
  const Vec3 w(n.dot((t[2] - t[1]).cross(q - t[1])), n.dot((t[0] - t[2]).cross(q - t[2])),
               n.dot((t[1] - t[0]).cross(q - t[0])));
  if (w.minCoeff() < 0) return false;
  const double sum = w.sum();
  if (!(sum > 0)) return false;
  bary = w / sum;
  return true;
}

}  // namespace

// Updates the candidates' bounds (in the free motion) and appends the contacts within `range`.
void ToolCollider::evaluate(const CollisionMesh& mesh, const PlacedPiece& at, const ToolContactSettings& settings,
                            double range, std::vector<Proximity>& found) {
  const double t = at.time;
  const double slid = at.shift.norm();
  const Vec3 side = t == 0 && slid == 0 ? side_[std::size_t(at.piece)] : Vec3(Vec3::Zero());
  const auto core = at.core();
  const bool on_path = slid == 0 && !at.expected;
  for (Candidate& k : candidates_) {
    if (k.clear - (at.expected ? k.to_end : k.speed * std::abs(t - k.time)) - slid > range) continue;
    const auto& v = mesh.triangle(k.triangle);
    const std::array<Vec3, 3> tri{mesh.vertex(v[0], t), mesh.vertex(v[1], t), mesh.vertex(v[2], t)};
    // First a cheap bound: sphere around the triangle, segment in the core.
    const Vec3 centre = (tri[0] + tri[1] + tri[2]) / 3;
    const double reach2 =
        std::max({(tri[0] - centre).squaredNorm(), (tri[1] - centre).squaredNorm(), (tri[2] - centre).squaredNorm()});
    const double s = closest_on_segment(centre, at.axis0, at.axis1);
    const double axis = (at.axis0 + s * (at.axis1 - at.axis0) - centre).norm();
    double clear = axis - std::sqrt(reach2) - at.bound - at.radius;
    if (clear > range) {
      if (on_path) {
        k.clear = clear;
        k.time = t;
      }
      continue;
    }
    const Narrow n = closest(core, tri, at.radius + range);
    clear = n.distance - at.radius;
    if (on_path) {
      k.clear = clear;
      k.time = t;
    }
    if (clear > range) continue;
    const Vec3 face = mesh.face_normal(k.triangle, t);

    Proximity x;
    x.piece = at.piece;
    x.triangle = k.triangle;
    x.time = t;
    const auto emit = [&](const Vec3& bary, const Vec3& c, const Vec3& normal, double gap) {
      x.bary = bary;
      x.point = c;
      x.normal = normal;
      x.gap = gap;
      x.local = at.pose.q.conjugate() * (c - at.pose.p);
      x.start_gap = gap;
      if (t > 0 || slid > 0) x.start_gap += normal.dot(at.start.apply(x.local) - mesh.point(k.triangle, bary));
      found.push_back(x);
    };
    if (n.distance < 1e-9) {
      // The core intersects this triangle and is pushed out along its normal by the core's depth.
      double deepest = 0;
      for (const Vec3& q : core) deepest = std::max(deepest, face.dot(tri[0] - q));
      emit(n.bary, n.c, face, -at.radius - std::min(deepest, settings.max_correction));
      continue;
    }
    const Vec3 d = (n.p - n.c) / n.distance;
    const TriangleFeature f = feature_of(n.bary);
    // A thin wall is wavy under a flat tool. All of it under the tool counts, not only its crests.
    const bool under = settings.offset > 0 && d.dot(face) > 0.8;
    if (under || mesh.locally_closest(k.triangle, f, d, t, 1e-6)) {
      const bool outside = d.dot(mesh.pseudo_normal(k.triangle, f, t)) >= 0;
      if (outside && clear <= settings.alarm) emit(n.bary, n.c, d, clear);
      // The core may be in front of another triangle. The nearest of all decides and gives the direction out.
      if (!outside && n.distance <= settings.max_depth) {
        NearestPoint e = mesh.nearest(n.p, t, n.distance);
        if (e.behind && e.outward.dot(side) < -0.2) e = mesh.nearest(n.p, t, settings.max_depth, &side);
        if (e.triangle >= 0 && e.behind) {
          x.triangle = e.triangle;
          emit(e.bary, e.point, e.outward, -e.distance - at.radius);
          x.triangle = k.triangle;
        }
      }
    }
    if (at.count < 2 || clear > settings.alarm) continue;
    for (int i = 0; i < at.count; ++i) {
      const Vec3& q = at.points[std::size_t(i)];
      const double h = face.dot(q - tri[0]);
      if (h <= 0 || h - at.radius > settings.alarm) continue;
      Vec3 bary;
      if (above(q, tri, face, bary)) emit(bary, q - h * face, face, h - at.radius);
    }
  }
}

// A piece behind the surface leaves through the nearest triangle on its own side. Contacts of opposite walls are
// dropped.
void ToolCollider::drop_wrong_exits(std::vector<Proximity>& found, const Vec3& side, double offset) const {
  const auto behind = [&](const Proximity& x) { return x.gap < -pieces_[std::size_t(x.piece)].radius - offset; };
  Vec3 out = Vec3::Zero();
  double least = 1e300;
  for (const Proximity& x : found) {
    if (!behind(x) || x.normal.dot(side) < -0.2) continue;
    if (-x.gap < least) {
      least = -x.gap;
      out = x.normal;
    }
  }
  std::size_t kept = 0;
  for (const Proximity& x : found)
    if (!behind(x) || (x.normal.dot(side) >= -0.2 && x.normal.dot(out) >= 0.3)) found[kept++] = x;
  found.resize(kept);
}

// Writes the contacts of a piece at its expected pose at the end of the step into at_end_. False if there are none, or
// if it would be behind a wall.
bool ToolCollider::found_at_end(const CollisionMesh& mesh, const PlacedPiece& expected,
                                const ToolContactSettings& settings) {
  at_end_.clear();
  evaluate(mesh, expected, settings, settings.alarm, at_end_);
  drop_wrong_exits(at_end_, side_[std::size_t(expected.piece)], settings.offset);
  for (Proximity& x : at_end_) {
    if (settings.offset > 0 && x.gap < -0.9 * expected.radius) return false;
    x.start_gap += std::max(0.0, -settings.max_correction - x.gap);
  }
  return !at_end_.empty();
}

}  // namespace insula
