// SPDX-License-Identifier: GPL-3.0-or-later
// Tool against surface, piece by piece: candidates, conservative advancement, sliding.
#include "core/collision/colliders/tool_collider.h"

#include <cmath>
#include <optional>

#include "core/collision/shapes/placed_piece.h"

namespace insula {
namespace {

bool touching(const Proximity& x, const ToolContactSettings& settings) { return x.gap <= 0.1 * settings.alarm; }

}  // namespace

/// Motion of a piece in the step.
struct ToolCollider::SweptPiece {
  const RoundedPiece& piece;
  int index;
  const Pose& start;
  const Vec6& motion;      ///< of the tool
  double offset, horizon;  ///< the motion is followed this far, in steps
  PlacedPiece first, last;
  std::optional<PlacedPiece> expected;  ///< at the step's end, if contacts are linearised there
  Vec3 velocity = Vec3::Zero(),
       to_end = Vec3::Zero();            ///< displacement of its middle in the free motion, and to `expected`, m ...
  double uneven = 0, uneven_to_end = 0;  ///< ... and the largest difference to that of any point
  double beyond = 0, farthest = 0;       ///< candidates in the free motion are within `beyond` of the swept box, and no
                                         ///< point moves farther than `farthest`
  Aabb box;

  SweptPiece(const RoundedPiece& r, int i, const Pose& from, const Vec6& by, const Pose& end, double ahead, double wall)
      : piece(r),
        index(i),
        start(from),
        motion(by),
        offset(wall),
        horizon(ahead),
        first(r, i, from, from, 0, Vec3::Zero(), wall),
        last(r, i, from, end, ahead, Vec3::Zero(), wall) {}

  double radius() const { return first.radius; }
  PlacedPiece at(double t, const Vec3& slid = Vec3::Zero()) const {
    if (slid.isZero(0) && t == 0) return first;
    if (slid.isZero(0) && t == horizon) return last;
    return PlacedPiece(piece, index, start, motion, t, slid, offset);
  }
  Vec3 velocity_of(const PlacedPiece& placed, const Vec3& local) const {
    return motion.head<3>() + motion.tail<3>().cross(placed.pose.q * local);
  }

  void expect(const Pose& pose) {
    expected.emplace(piece, index, start, pose, 1, Vec3::Zero(), offset);
    expected->expected = true;
    const auto gone = [&](int i) { return Vec3(expected->points[std::size_t(i)] - first.points[std::size_t(i)]); };
    for (int i = 0; i < first.count; ++i) to_end += gone(i) / first.count;
    for (int i = 0; i < first.count; ++i) {
      box.add(expected->points[std::size_t(i)]);
      farthest = std::max(farthest, gone(i).norm());
      uneven_to_end = std::max(uneven_to_end, (gone(i) - to_end).norm());
    }
  }
  /// Sets the box of all that may come within `range`. A pose after sliding leaves the swept box by at most half its
  /// motion.
  void sweep(double range) {
    Vec3 centre = Vec3::Zero();
    for (int i = 0; i < first.count; ++i) centre += first.points[std::size_t(i)];
    centre /= first.count;
    double spread = 0;
    for (int i = 0; i < first.count; ++i) {
      const Vec3 &p = first.points[std::size_t(i)], &q = last.points[std::size_t(i)];
      box.add(p);
      box.add(q);
      farthest = std::max(farthest, (q - p).norm());
      spread = std::max(spread, (p - centre).norm());
    }
    const double turn = motion.tail<3>().norm(), lever = (centre - start.p).norm();
    beyond = radius() + range + 0.5 * farthest + turn * turn * (lever + spread);
    box.inflate(beyond);
    velocity = motion.head<3>() + motion.tail<3>().cross(centre - start.p);
    uneven = turn * (spread + turn * lever);
  }
  // The box of an oblique piece is mostly empty. So the distance of a leaf from the segment in the core decides.
  bool passes(const Aabb& leaf) const {
    const Vec3 middle = 0.5 * (leaf.low + leaf.high);
    const double s = closest_on_segment(middle, first.axis0, first.axis1),
                 most = first.bound + farthest + beyond + 0.5 * (leaf.high - leaf.low).norm();
    return (first.axis0 + s * (first.axis1 - first.axis0) - middle).squaredNorm() <= most * most;
  }
};

/// Result of the advance of a piece.
struct ToolCollider::Reached {
  double time = 0;  ///< time of touch, or the end of the motion
  bool touches = false;
  bool at_end = false;  ///< its contacts of the start were taken at the step's end
};

ToolCollider::ToolCollider(const std::vector<ConvexPiece>& pieces, int triangles)
    : ToolCollider(pieces.size(), triangles) {
  for (const ConvexPiece& p : pieces) add_piece() = rounded(p);
}

ToolCollider::ToolCollider(std::size_t most_pieces, int triangles) : pieces_(most_pieces) {
  for (RoundedPiece& p : pieces_) p.core.reserve(RoundedPiece::max_core);
  reset();
  candidates_.reserve(std::size_t(triangles));
  const std::size_t room = std::min<std::size_t>(4096, (RoundedPiece::max_core + 2) * std::size_t(triangles));
  found_.reserve(room);  // of one piece
  at_end_.reserve(room);
  touch_normals_.reserve(max_touch_normals);
}

void ToolCollider::clear_pieces() {
  used_ = 0;
  reset();
}

RoundedPiece& ToolCollider::add_piece() {
  RoundedPiece& piece = pieces_[used_++];
  piece.core.clear();
  return piece;
}

void ToolCollider::reset() {
  deep_.assign(pieces_.size(), 1);
  side_.assign(pieces_.size(), Vec3::Zero());
}

void ToolCollider::list_candidates(const CollisionMesh& mesh, const SweptPiece& swept) {
  candidates_.clear();
  const auto passed = [&](const Aabb& leaf) { return swept.passes(leaf); };
  mesh.tree().overlapping(swept.box, passed, [&](int tri) {
    double speed2 = 0, to_end2 = 0;
    for (int v : mesh.triangle(tri)) {
      speed2 = std::max(speed2, (mesh.free(v) - swept.velocity).squaredNorm());
      if (swept.expected) to_end2 = std::max(to_end2, (mesh.free(v) - swept.to_end).squaredNorm());
    }
    candidates_.push_back({tri, 0.0, 0.0, std::sqrt(speed2) + swept.uneven, std::sqrt(to_end2) + swept.uneven_to_end});
  });
}

// An overlap is reduced by at most max_correction in a step.
void ToolCollider::add(Proximity x, const ToolContactSettings& settings, std::vector<Proximity>& out) {
  x.start_gap = std::max(x.start_gap, -settings.max_correction);
  out.push_back(x);
}

// Adds the contacts of the start to `out`: those at the present pose, which were just evaluated, or those at the
// expected pose at the step's end. Returns whether the latter.
bool ToolCollider::take_contacts_of_start(const CollisionMesh& mesh, const SweptPiece& swept,
                                          const ToolContactSettings& settings, std::vector<Proximity>& out) {
  const bool ends = swept.expected && found_at_end(mesh, *swept.expected, settings);
  drop_wrong_exits(found_, side_[std::size_t(swept.index)], settings.offset);
  const bool deep = remember_side(swept.index, swept.radius()), at_end = ends && !deep;
  if (at_end) out.insert(out.end(), at_end_.begin(), at_end_.end());
  else
    for (const Proximity& x : found_) add(x, settings, out);
  return at_end;
}

// Conservative advancement. The contacts at the reached pose remain in found_.
ToolCollider::Reached ToolCollider::advance(const CollisionMesh& mesh, const SweptPiece& swept,
                                            const ToolContactSettings& settings, double range,
                                            std::vector<Proximity>& out) {
  Reached r;
  for (int iteration = 0; iteration < 64; ++iteration) {
    const PlacedPiece at = swept.at(r.time);
    found_.clear();
    evaluate(mesh, at, settings, r.time == 0 ? range : settings.alarm, found_);
    if (r.time == 0) r.at_end = take_contacts_of_start(mesh, swept, settings, out);
    r.touches = false;
    for (const Proximity& x : found_) {
      const Vec3 v = swept.velocity_of(at, x.local) - mesh.free_at(x.triangle, x.bary);
      r.touches = r.touches || (touching(x, settings) && x.normal.dot(v) < 0);
    }
    if (r.touches || r.time >= swept.horizon) break;
    // Time in which nothing can be touched.
    double next = swept.horizon, fastest = 0;
    for (const Candidate& k : candidates_) {
      if (!(k.speed > 0)) continue;
      fastest = std::max(fastest, k.speed);
      next = std::min(next, k.time + std::max(0.0, k.clear) / k.speed);
    }
    if (fastest > 0) next = std::max(next, r.time + 0.5 * settings.alarm / fastest);
    r.time = std::min(swept.horizon, next);
  }
  return r;
}

// Slides along the contacts in found_ (out of the surface, if behind it) by the remaining motion.
void ToolCollider::slide_on(const CollisionMesh& mesh, const SweptPiece& swept, double t,
                            const ToolContactSettings& settings, std::vector<Proximity>& out) {
  const Proximity* touched = &found_[0];
  for (const Proximity& x : found_)
    if (x.gap < touched->gap) touched = &x;
  Vec3 slide = (1 - t) * (swept.velocity - mesh.free_at(touched->triangle, touched->bary));
  for (int pass = 0; pass < 3; ++pass)
    for (const Proximity& x : found_) {
      const double c = x.normal.dot(slide) + std::max(-settings.max_correction, x.gap);
      if (c < 0) slide -= c * x.normal;
    }
  for (int attempt = 0; attempt < 3 && slide.norm() > 0.25 * settings.alarm; ++attempt, slide *= 0.5) {
    found_.clear();
    evaluate(mesh, swept.at(t, slide), settings, settings.alarm, found_);
    double least = 0;
    for (const Proximity& x : found_) least = std::min(least, x.gap);
    if (least < -0.5 * settings.alarm) continue;
    add_those_on_free_side(settings, out);
    break;
  }
}

void ToolCollider::add_those_on_free_side(const ToolContactSettings& settings, std::vector<Proximity>& out) const {
  for (const Proximity& x : found_)
    if (x.start_gap >= -0.05 * settings.alarm) add(x, settings, out);
}

void ToolCollider::detect(const CollisionMesh& mesh, const Pose& start, const Pose& free,
                          const ToolContactSettings& settings, std::vector<Proximity>& out) {
  touch_time_ = 1;
  touching_piece_ = -1;
  touch_normals_.clear();
  overlap_at_end_ = 0;
  if (mesh.tree().empty()) return;
  const Vec6 motion = displacement(start, free);
  const double horizon = 1 + settings.collision_horizon;
  const Pose end = displaced(start, horizon * motion);
  for (int index = 0; index < int(used_); ++index) {
    SweptPiece swept(pieces_[std::size_t(index)], index, start, motion, end, horizon, settings.offset);
    char& deep = deep_[std::size_t(index)];
    const double range = deep ? std::max(settings.alarm, settings.max_depth - swept.radius()) : settings.alarm;
    if (settings.expected && !deep) swept.expect(*settings.expected);
    deep = 0;
    swept.sweep(range);
    list_candidates(mesh, swept);
    if (candidates_.empty()) {
      side_[std::size_t(index)].setZero();
      continue;
    }
    const Reached reached = advance(mesh, swept, settings, range, out);
    if (reached.touches && reached.time <= 1 && (touching_piece_ < 0 || reached.time < touch_time_)) {
      touch_time_ = reached.time;
      touching_piece_ = index;
      touch_normals_.clear();
      for (const Proximity& x : found_)
        if (touching(x, settings) && touch_normals_.size() < max_touch_normals) touch_normals_.push_back(x.normal);
      overlap_at_end_ = find_overlap(mesh, swept.at(1), settings);
    }
    if (reached.time > 0) add_those_on_free_side(settings, out);
    // If contacts were taken at the end, the result of sliding is already known.
    if (!reached.at_end && reached.touches && reached.time < 1 && !found_.empty())
      slide_on(mesh, swept, reached.time, settings, out);
  }
}

}  // namespace insula
