// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts of a tool's piece with a surface at one moment of the step.
#include <array>
#include <cmath>
#include <limits>

#include "core/collision/colliders/curved_contact.h"
#include "core/collision/shapes/core_triangle.h"
#include "core/collision/shapes/placed_piece.h"

namespace insula {

namespace {

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

/// Appends the contacts of a placed piece with one triangle.
struct ToolCollider::ContactsOfTriangle {
  const CollisionMesh& mesh;
  const PlacedPiece& at;
  const ToolContactSettings& settings;
  int triangle;
  const std::array<Vec3, 3>& tri;
  Vec3 face;  ///< unit normal of the triangle
  std::vector<Proximity>& found;

  void add(int on, const Vec3& bary, const Vec3& c, const Vec3& normal, double gap) const {
    Proximity x;
    x.piece = at.piece;
    x.triangle = on;
    x.time = at.time;
    x.bary = bary;
    x.point = c;
    x.normal = normal;
    x.gap = gap;
    x.local = at.pose.q.conjugate() * (c - at.pose.p);
    x.start_gap = gap;
    if (at.time > 0 || at.shift.norm() > 0) x.start_gap += normal.dot(at.start.apply(x.local) - mesh.point(on, bary));
    found.push_back(x);
  }

  /// Adds a contact in front of the surface, of all of the core or of a corner.
  void add_outside(std::span<const Vec3> core, const Vec3& bary, const Vec3& c, const Vec3& normal, double gap) const {
    if (!settings.curved) return add(triangle, bary, c, normal, gap);
    const CurvedContact x = nearest_on_curved(mesh, at.time, core, triangle, bary);
    if (x.distance - at.radius > settings.alarm || x.distance < -settings.max_depth) return;
    add(x.triangle, x.bary, mesh.point(x.triangle, x.bary, at.time), x.normal, x.distance - at.radius);
  }

  /// Adds a contact of a core that is behind the flat surface.
  void add_inside(int on, const Vec3& bary, const Vec3& c, const Vec3& normal, double gap) const {
    if (settings.curved) gap -= normal.dot(bulge_at(mesh, at.time, on, bary));
    add(on, bary, c, normal, gap);
  }

  /// Adds the contact of a core that intersects this triangle. It is pushed out along the normal by the core's depth.
  void add_intersecting(const CoreDistance& n) const {
    double deepest = 0;
    for (const Vec3& q : at.core()) deepest = std::max(deepest, face.dot(tri[0] - q));
    add_inside(triangle, n.bary, n.c, face, -at.radius - std::min(deepest, settings.max_correction));
  }

  void add_nearest(const CoreDistance& n, const Vec3& side) const {
    const double t = at.time, clear = n.distance - at.radius;
    const Vec3 d = (n.p - n.c) / n.distance;
    const TriangleFeature f = feature_of(n.bary);
    // A thin wall is wavy under a flat tool. All of it under the tool counts, not only its crests.
    const bool under = settings.offset > 0 && d.dot(face) > 0.8;
    if (!under && !mesh.locally_closest(triangle, f, d, t, 1e-6)) return;
    const bool outside = d.dot(mesh.pseudo_normal(triangle, f, t)) >= 0;
    if (outside && clear <= settings.alarm) add_outside(at.core(), n.bary, n.c, d, clear);
    if (outside || n.distance > settings.max_depth) return;
    // The core may be in front of another triangle. The nearest of all decides and gives the direction out.
    NearestPoint e = mesh.nearest(n.p, t, n.distance);
    if (e.behind && e.outward.dot(side) < -0.2) e = mesh.nearest(n.p, t, settings.max_depth, &side);
    if (e.triangle >= 0 && e.behind) add_inside(e.triangle, e.bary, e.point, e.outward, -e.distance - at.radius);
  }

  /// Adds the corners of the core that are right above the triangle.
  void add_corners() const {
    for (const Vec3& q : at.core()) {
      const double h = face.dot(q - tri[0]);
      if (h <= 0 || h - at.radius > settings.alarm) continue;
      Vec3 bary;
      if (above(q, tri, face, bary)) add_outside({&q, 1}, bary, q - h * face, face, h - at.radius);
    }
  }
};

// Updates a candidate's bounds for the pose of the piece. False if it is out of range.
bool ToolCollider::within_range(Candidate& k, const PlacedPiece& at, const std::array<Vec3, 3>& tri, double range,
                                CoreDistance& n) {
  const bool on_path = at.shift.norm() == 0 && !at.expected;
  // First a cheap bound: sphere around the triangle, segment in the core.
  const Vec3 centre = (tri[0] + tri[1] + tri[2]) / 3;
  const double reach2 =
      std::max({(tri[0] - centre).squaredNorm(), (tri[1] - centre).squaredNorm(), (tri[2] - centre).squaredNorm()});
  const double s = closest_on_segment(centre, at.axis0, at.axis1);
  const double axis = (at.axis0 + s * (at.axis1 - at.axis0) - centre).norm();
  double clear = axis - std::sqrt(reach2) - at.bound - at.radius;
  if (clear <= range) {
    n = core_triangle(at.core(), tri, at.radius + range);
    clear = n.distance - at.radius;
  }
  if (on_path) {
    k.clear = clear;
    k.time = at.time;
  }
  return clear <= range;
}

// Updates the candidates' bounds (in the free motion) and appends the contacts within `range`.
void ToolCollider::evaluate(const CollisionMesh& mesh, const PlacedPiece& at, const ToolContactSettings& settings,
                            double range, std::vector<Proximity>& found) {
  const double t = at.time;
  const double slid = at.shift.norm();
  const Vec3 side = t == 0 && slid == 0 ? side_[std::size_t(at.piece)] : Vec3(Vec3::Zero());
  for (Candidate& k : candidates_) {
    if (k.clear - (at.expected ? k.to_end : k.speed * std::abs(t - k.time)) - slid > range) continue;
    const auto& v = mesh.triangle(k.triangle);
    const std::array<Vec3, 3> tri{mesh.vertex(v[0], t), mesh.vertex(v[1], t), mesh.vertex(v[2], t)};
    CoreDistance n;
    if (!within_range(k, at, tri, range, n)) continue;
    const ContactsOfTriangle contacts{mesh, at, settings, k.triangle, tri, mesh.face_normal(k.triangle, t), found};
    if (n.distance < 1e-9) {
      contacts.add_intersecting(n);
      continue;
    }
    contacts.add_nearest(n, side);
    if (at.count >= 2 && n.distance - at.radius <= settings.alarm) contacts.add_corners();
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

// Keeps whether the piece is behind the surface, and the side on which it is near. Returns the first.
bool ToolCollider::remember_side(int piece, double radius) {
  const double depth = -0.9 * radius;
  double least = 1e300;
  Vec3 nearest = Vec3::Zero();
  bool deep = false;
  for (const Proximity& x : found_) {
    deep = deep || x.gap < depth;
    if (x.gap < least) {
      least = x.gap;
      nearest = x.normal;
    }
  }
  deep_[std::size_t(piece)] = deep;
  if (least > depth) side_[std::size_t(piece)] = nearest;  // zero if nothing is near
  return deep;
}

void ToolCollider::detect_at(const CollisionMesh& mesh, const Pose& pose, const ToolContactSettings& settings,
                             std::vector<Proximity>& out) {
  for (int index = 0; index < int(used_); ++index) {
    candidates_.clear();  // their bounds are those of a piece
    for (int t = 0; t < mesh.triangle_count(); ++t) candidates_.push_back({t, 0, 0, 0, 0});
    const RoundedPiece& piece = pieces_[std::size_t(index)];
    const PlacedPiece at(piece, index, pose, pose, 0, Vec3::Zero(), settings.offset);
    const double range =
        deep_[std::size_t(index)] ? std::max(settings.alarm, settings.max_depth - at.radius) : settings.alarm;
    found_.clear();
    evaluate(mesh, at, settings, range, found_);
    drop_wrong_exits(found_, side_[std::size_t(index)], settings.offset);
    remember_side(index, at.radius);
    for (const Proximity& x : found_)
      if (out.size() < out.capacity()) add(x, settings, out);
  }
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

double ToolCollider::find_overlap(const CollisionMesh& mesh, const PlacedPiece& at,
                                  const ToolContactSettings& settings) {
  at_end_.clear();
  evaluate(mesh, at, settings, settings.alarm, at_end_);
  if (at_end_.empty()) return 0;
  drop_wrong_exits(at_end_, side_[std::size_t(at.piece)], settings.offset);
  if (at_end_.empty()) return std::numeric_limits<double>::infinity();
  double overlap = 0;
  for (const Proximity& x : at_end_) overlap = std::max(overlap, -x.gap);
  return overlap;
}

}  // namespace insula
