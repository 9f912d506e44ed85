// SPDX-License-Identifier: GPL-3.0-or-later
// Tool against tool along a step.
#include "core/collision/colliders/tool_pair.h"

#include <algorithm>
#include <cmath>

#include "core/collision/shapes/closest.h"
#include "core/collision/shapes/gjk.h"

namespace insula {
namespace {

constexpr double shortest_path_m = 2e-5;   // below it, a step has the contacts of its start
constexpr double part_m = 2e-4;            // about the smallest radius of a tip
constexpr int max_parts = 16;              // of the step, and of the time beyond it
constexpr double same_direction = 0.9994;  // 2 degrees

/// Displacement of a point of a rigid body, m.
double moved(const Vec6& d, const Vec3& point, const Vec3& origin) {
  return (d.head<3>() + d.tail<3>().cross(point - origin)).norm();
}

using Core = std::array<Vec3, RoundedPiece::max_core>;

/// Two pieces at a moment of the step.
struct Place {
  double time = 0;
  Pose a, b;
  Vec3 normal = Vec3::UnitZ();  ///< from b to a
  Vec3 point = Vec3::Zero();    ///< on b
  double gap = 0;
};

class PiecePair {
 public:
  PiecePair(const RoundedPiece& x, const ToolMotion& a, const RoundedPiece& y, const ToolMotion& b)
      : x_(x), y_(y), a_(a.start), b_(b.start), da_(displacement(a.start, a.end)), db_(displacement(b.start, b.end)) {
    a0_ = a_.apply(x.axis0);
    a1_ = a_.apply(x.axis1);
    b0_ = b_.apply(y.axis0);
    b1_ = b_.apply(y.axis1);
    path_ =
        std::max(moved(da_, a0_, a_.p), moved(da_, a1_, a_.p)) + std::max(moved(db_, b0_, b_.p), moved(db_, b1_, b_.p));
    double s, t;
    closest_segments(a0_, a1_, b0_, b1_, s, t);
    between_axes_ = a0_ + s * (a1_ - a0_) - b0_ - t * (b1_ - b0_);
  }

  /// Bound of the relative motion in the step, m.
  double path() const { return path_; }
  /// Lower bound of the gap at the start, m.
  double least_gap() const { return between_axes_.norm() - x_.radius - x_.bound - y_.radius - y_.bound; }

  Place start() const {
    Vec3 n = between_axes_;
    if (n.norm() < 1e-9) n = 0.5 * (a0_ + a1_ - b0_ - b1_);
    if (n.norm() < 1e-12) n = Vec3::UnitZ();
    return at(0, Vec3::Zero(), n.normalized(), false);
  }

  /// `last`: normal a short time before. If the cores meet or have changed sides since then, it is the normal.
  Place at(double time, const Vec3& shift, const Vec3& last, bool keeps_side = true) const {
    Place out;
    out.time = time;
    out.a = time > 0 ? displaced(a_, time * da_) : a_;
    out.a.p += shift;
    out.b = time > 0 ? displaced(b_, time * db_) : b_;
    Core pa, pb;
    for (std::size_t k = 0; k < x_.core.size(); ++k) pa[k] = out.a.apply(x_.core[k]);
    for (std::size_t k = 0; k < y_.core.size(); ++k) pb[k] = out.b.apply(y_.core[k]);
    const HullDistance d = hull_distance({pa.data(), x_.core.size()}, {pb.data(), y_.core.size()});
    const Vec3 n = d.a - d.b;
    if (d.distance >= 1e-9 && !(keeps_side && n.dot(last) < 0)) {
      out.normal = n.normalized();
      out.gap = d.distance - x_.radius - y_.radius;
    } else {
      out.normal = last;
      out.gap = keeps_side ? separation(pa, pb, last) : -x_.radius - y_.radius;
    }
    out.point = d.b + out.normal * y_.radius;
    return out;
  }

  /// Moves the pair on to a later moment. `shift`: displacement of a that keeps the gap from falling below `least`.
  void advance(Place& place, double time, double least, Vec3& shift) const {
    constexpr int iterations = 4;
    place = at(time, shift, place.normal);
    for (int k = 0; k < iterations && (place.gap < least || !shift.isZero()); ++k) {
      shift = std::max(0.0, shift.dot(place.normal) + least - place.gap) * place.normal;
      place = at(time, shift, place.normal);
    }
  }

  Proximity contact(const Place& p, double max_correction) const {
    Proximity c;
    c.normal = p.normal;
    c.point = p.point;
    c.gap = p.gap;
    c.time = p.time;
    c.local = p.a.q.conjugate() * (p.point - p.a.p);
    c.other_local = p.b.q.conjugate() * (p.point - p.b.p);
    c.start_gap = std::max(p.gap, -max_correction);
    if (p.time > 0) c.start_gap += p.normal.dot(a_.apply(c.local) - b_.apply(c.other_local));
    return c;
  }

  /// Of a contact after the free motion of the step, m.
  double gap_at_end(const Proximity& c) const {
    const Vec3 a = displaced(a_, da_).apply(c.local), b = displaced(b_, db_).apply(c.other_local);
    return c.start_gap + c.normal.dot(a - a_.apply(c.local) - b + b_.apply(c.other_local));
  }

 private:
  double separation(const Core& pa, const Core& pb, const Vec3& n) const {
    double a = n.dot(pa[0]), b = n.dot(pb[0]);
    for (std::size_t k = 1; k < x_.core.size(); ++k) a = std::min(a, n.dot(pa[k]));
    for (std::size_t k = 1; k < y_.core.size(); ++k) b = std::max(b, n.dot(pb[k]));
    return a - b - x_.radius - y_.radius;
  }

  const RoundedPiece &x_, &y_;
  Pose a_, b_;
  Vec6 da_, db_;
  Vec3 a0_, a1_, b0_, b1_, between_axes_;
  double path_ = 0;
};

/// Follows a pair, from its start on.
class Path {
 public:
  Path(const PiecePair& pair, const Place& start)
      : pair_(pair), place_(start), nearest_(start), first_gap_(start.gap), least_(std::min(0.0, start.gap)) {}
  void follow(double until, double longest) {
    const double length = (until - place_.time) * pair_.path(), from = place_.time;
    const int parts = first_gap_ > longest ? 1 : std::clamp(int(std::ceil(length / part_m)), 1, max_parts);
    for (int k = 1; k <= parts; ++k) {
      pair_.advance(place_, from + (until - from) * k / parts, least_, shift_);
      if (place_.gap < nearest_.gap) nearest_ = place_;
    }
  }
  const Place& place() const { return place_; }
  const Place& nearest() const { return nearest_; }
  bool slides() const { return !shift_.isZero(); }

 private:
  const PiecePair& pair_;
  Place place_, nearest_;
  double first_gap_, least_;
  Vec3 shift_ = Vec3::Zero();
};

/// The contact of a pair; false: none. That of the start is kept if its plane is right: faces that lie flat on one
/// another have many nearest points, and theirs shall stay.
bool find_contact(const PiecePair& pair, const ToolContactSettings& settings, Proximity& out) {
  const double horizon = 1 + settings.collision_horizon, longest = horizon * pair.path();
  if (pair.least_gap() > settings.alarm + longest) return false;
  const Place start = pair.start();
  if (start.gap > settings.alarm + longest) return false;
  out = pair.contact(start, settings.max_correction);
  if (pair.path() < shortest_path_m) return start.gap <= settings.alarm;
  const auto take = [&](const Place& place) {
    if (place.normal.dot(start.normal) < same_direction) out = pair.contact(place, settings.max_correction);
  };
  Path path(pair, start);
  path.follow(1, longest);
  if (path.slides()) return take(path.place()), true;
  const Place end = path.place();
  if (horizon > 1) path.follow(horizon, longest);
  const bool acts_within = pair.gap_at_end(pair.contact(path.nearest(), settings.max_correction)) < 0;
  take(acts_within ? end : path.nearest());
  return path.nearest().gap <= settings.alarm;
}

}  // namespace

void detect_tools(const std::vector<RoundedPiece>& a, const ToolMotion& motion_a, const std::vector<RoundedPiece>& b,
                  const ToolMotion& motion_b, const ToolContactSettings& settings, std::vector<Proximity>& out) {
  for (int i = 0; i < int(a.size()); ++i)
    for (int j = 0; j < int(b.size()); ++j) {
      Proximity c;
      if (!find_contact({a[std::size_t(i)], motion_a, b[std::size_t(j)], motion_b}, settings, c)) continue;
      c.piece = i;
      c.other_piece = j;
      out.push_back(c);
    }
}

}  // namespace insula
