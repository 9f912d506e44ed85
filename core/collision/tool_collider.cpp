// SPDX-License-Identifier: GPL-3.0-or-later
// Tool against surface: broad phase, conservative advancement, contacts.
#include "core/collision/tool_collider.h"

#include <array>
#include <cmath>
#include <optional>

#include "core/collision/gjk.h"

namespace insula {

namespace {

constexpr int max_core = 24;  // read_tool refuses more

struct Narrow {
  double distance = 0;  ///< of the core, unsigned
  Vec3 p, c, bary;
};

// Exact if no farther than `limit`, else no more than the distance.
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

/// A piece at a moment of the step, in the scene frame.
struct ToolCollider::Placed {
  int piece = 0;
  double time = 0;
  Vec3 shift = Vec3::Zero();  // slid by this from the free path
  Pose start, pose;           // pose: at `time`, shift included
  std::array<Vec3, max_core> points;
  int count = 0;
  Vec3 axis0, axis1;
  double radius = 0, bound = 0;
  bool expected = false;  ///< at the end of the step, not on the free way

  Placed(const RoundedPiece& r, int index, const Pose& s, const Vec6& motion, double t, const Vec3& slid, double offset)
      : Placed(r, index, s, t > 0 ? displaced(s, t * motion) : s, t, slid, offset) {}
  /// `there`: the start pose displaced by t of the motion.
  Placed(const RoundedPiece& r, int index, const Pose& s, const Pose& there, double t, const Vec3& slid, double offset)
      : piece(index), time(t), shift(slid), start(s), pose(there) {
    pose.p += slid;
    const Mat3 rotation = pose.q.toRotationMatrix();
    count = int(r.core.size());
    for (int i = 0; i < count; ++i) points[std::size_t(i)] = pose.p + rotation * r.core[std::size_t(i)];
    axis0 = pose.p + rotation * r.axis0;
    axis1 = pose.p + rotation * r.axis1;
    radius = r.radius + offset;
    bound = r.bound;
  }
  std::span<const Vec3> core() const { return {points.data(), std::size_t(count)}; }
};

ToolCollider::ToolCollider(const std::vector<ConvexPiece>& pieces, int triangles) {
  for (const ConvexPiece& p : pieces) pieces_.push_back(rounded(p));
  reset();
  candidates_.reserve(std::size_t(triangles));
  found_.reserve(4096);
  at_end_.reserve(4096);
}

void ToolCollider::reset() {
  deep_.assign(pieces_.size(), 1);
  side_.assign(pieces_.size(), Vec3::Zero());
}

// Brings the candidates' bounds up to date (on the free way) and appends the contacts within `range`.
void ToolCollider::evaluate(const CollisionMesh& mesh, const Placed& at, const ToolContactSettings& settings, double range,
                            std::vector<Proximity>& found) {
  const double t = at.time;
  const double slid = at.shift.norm();
  const Vec3 side = t == 0 && slid == 0 ? side_[std::size_t(at.piece)] : Vec3(Vec3::Zero());
  const auto core = at.core();
  const bool on_way = slid == 0 && !at.expected;
  for (Candidate& k : candidates_) {
    if (k.clear - (at.expected ? k.to_end : k.speed * std::abs(t - k.time)) - slid > range) continue;
    const auto& v = mesh.triangle(k.triangle);
    const std::array<Vec3, 3> tri{mesh.vertex(v[0], t), mesh.vertex(v[1], t), mesh.vertex(v[2], t)};
    // Cheap bound first: sphere about the triangle, segment about the core.
    const Vec3 centre = (tri[0] + tri[1] + tri[2]) / 3;
    const double reach2 = std::max({(tri[0] - centre).squaredNorm(), (tri[1] - centre).squaredNorm(), (tri[2] - centre).squaredNorm()});
    const double s = closest_on_segment(centre, at.axis0, at.axis1);
    const double axis = (at.axis0 + s * (at.axis1 - at.axis0) - centre).norm();
    double clear = axis - std::sqrt(reach2) - at.bound - at.radius;
    if (clear > range) {
      if (on_way) {
        k.clear = clear;
        k.time = t;
      }
      continue;
    }
    const Narrow n = closest(core, tri, at.radius + range);
    clear = n.distance - at.radius;
    if (on_way) {
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
      // The core goes through this triangle: out along its normal, as deep as the core reaches.
      double deepest = 0;
      for (const Vec3& q : core) deepest = std::max(deepest, face.dot(tri[0] - q));
      emit(n.bary, n.c, face, -at.radius - std::min(deepest, settings.max_recovery));
      continue;
    }
    const Vec3 d = (n.p - n.c) / n.distance;
    const TriangleFeature f = feature_of(n.bary);
    // A thin wall is wavy under a flat tool: all that lies under it counts, not only its crests.
    const bool under = settings.offset > 0 && d.dot(face) > 0.8;
    if (under || mesh.locally_closest(k.triangle, f, d, t, 1e-6)) {
      const bool outside = d.dot(mesh.pseudo_normal(k.triangle, f, t)) >= 0;
      if (outside && clear <= settings.alarm) emit(n.bary, n.c, d, clear);
      // Behind this triangle, but perhaps before another one: only the nearest of all tells, and it is the way out.
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

// Behind the surface the way out is the nearest one on the piece's own side: contacts of opposite walls are dropped.
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

// The contacts of a piece where it is expected at the end of the step, into at_end_, after those at its start. False where there are none, or
// where it would be behind a wall.
bool ToolCollider::found_at_end(const CollisionMesh& mesh, const Placed& expected, const ToolContactSettings& settings) {
  at_end_.clear();
  evaluate(mesh, expected, settings, settings.alarm, at_end_);
  drop_wrong_exits(at_end_, side_[std::size_t(expected.piece)], settings.offset);
  for (Proximity& x : at_end_) {
    if (settings.offset > 0 && x.gap < -0.9 * expected.radius) return false;
    x.start_gap += std::max(0.0, -settings.max_recovery - x.gap);
  }
  return !at_end_.empty();
}

void ToolCollider::detect(const CollisionMesh& mesh, const Pose& start, const Pose& free, const ToolContactSettings& settings,
                          std::vector<Proximity>& out) {
  touch_time_ = 1;
  touching_piece_ = -1;
  if (mesh.tree().empty()) return;
  const Vec6 motion = displacement(start, free);
  const double turn = motion.tail<3>().norm();
  const double alarm = settings.alarm, horizon = 1 + settings.look_ahead;
  const Pose end = displaced(start, horizon * motion);
  // An overlap is undone by no more than max_recovery in a step.
  const auto add = [&](Proximity x) {
    x.start_gap = std::max(x.start_gap, -settings.max_recovery);
    out.push_back(x);
  };
  for (int index = 0; index < int(pieces_.size()); ++index) {
    const RoundedPiece& piece = pieces_[std::size_t(index)];
    const double radius = piece.radius + settings.offset;
    const Placed first(piece, index, start, start, 0, Vec3::Zero(), settings.offset), last(piece, index, start, end, horizon, Vec3::Zero(), settings.offset);
    const bool deep = deep_[std::size_t(index)] != 0;
    deep_[std::size_t(index)] = 0;
    const double range = deep ? std::max(alarm, settings.max_depth - radius) : alarm;

    // Everything the piece may meet on its way. A slid pose leaves the swept box by half its motion at most.
    Aabb box;
    double farthest = 0, spread = 0;
    Vec3 centre = Vec3::Zero();
    for (int i = 0; i < first.count; ++i) centre += first.points[std::size_t(i)];
    centre /= first.count;
    std::optional<Placed> expected;
    Vec3 to_end = Vec3::Zero();
    double uneven_to_end = 0;
    if (settings.expected && !deep) {
      expected.emplace(piece, index, start, *settings.expected, 1, Vec3::Zero(), settings.offset);
      expected->expected = true;
      const auto way = [&](int i) { return Vec3(expected->points[std::size_t(i)] - first.points[std::size_t(i)]); };
      for (int i = 0; i < first.count; ++i) to_end += way(i) / first.count;
      for (int i = 0; i < first.count; ++i) {
        box.add(expected->points[std::size_t(i)]);
        farthest = std::max(farthest, way(i).norm());
        uneven_to_end = std::max(uneven_to_end, (way(i) - to_end).norm());
      }
    }
    for (int i = 0; i < first.count; ++i) {
      const Vec3 &p = first.points[std::size_t(i)], &q = last.points[std::size_t(i)];
      box.add(p);
      box.add(q);
      farthest = std::max(farthest, (q - p).norm());
      spread = std::max(spread, (p - centre).norm());
    }
    const double lever = (centre - start.p).norm();
    const double beyond = radius + range + 0.5 * farthest + turn * turn * (lever + spread);
    box.inflate(beyond);
    // The box of a piece that lies askew is mostly empty: what counts is how far a leaf is from the segment the core lies about.
    const auto beside = [&](const Aabb& leaf) {
      const Vec3 middle = 0.5 * (leaf.low + leaf.high);
      const double s = closest_on_segment(middle, first.axis0, first.axis1), most = first.bound + farthest + beyond + 0.5 * (leaf.high - leaf.low).norm();
      return (first.axis0 + s * (first.axis1 - first.axis0) - middle).squaredNorm() <= most * most;
    };
    candidates_.clear();
    const Vec3 velocity = motion.head<3>() + motion.tail<3>().cross(centre - start.p);
    const double uneven = turn * (spread + turn * lever);
    mesh.tree().overlapping(box, beside, [&](int tri) {
      double speed2 = 0, to_end2 = 0;
      for (int v : mesh.triangle(tri)) {
        speed2 = std::max(speed2, (mesh.free(v) - velocity).squaredNorm());
        if (expected) to_end2 = std::max(to_end2, (mesh.free(v) - to_end).squaredNorm());
      }
      candidates_.push_back({tri, 0.0, 0.0, std::sqrt(speed2) + uneven, std::sqrt(to_end2) + uneven_to_end});
    });
    if (candidates_.empty()) {
      side_[std::size_t(index)].setZero();
      continue;
    }

    bool at_end = false;
    double t = 0;
    bool reached = false;
    Placed at = first;
    for (int iteration = 0; iteration < 64; ++iteration) {
      if (iteration > 0) at = t == horizon ? last : Placed(piece, index, start, motion, t, Vec3::Zero(), settings.offset);
      found_.clear();
      evaluate(mesh, at, settings, t == 0 ? range : alarm, found_);
      if (t == 0) {
        at_end = expected && found_at_end(mesh, *expected, settings);
        Vec3& side = side_[std::size_t(index)];
        drop_wrong_exits(found_, side, settings.offset);
        double least = 1e300;
        Vec3 nearest = Vec3::Zero();
        for (const Proximity& x : found_) {
          if (x.gap < -0.9 * radius) deep_[std::size_t(index)] = 1;
          if (x.gap < least) {
            least = x.gap;
            nearest = x.normal;
          }
        }
        at_end = at_end && !deep_[std::size_t(index)];
        if (at_end) out.insert(out.end(), at_end_.begin(), at_end_.end());
        else for (const Proximity& x : found_) add(x);
        if (least > -0.9 * radius) side = nearest;  // zero where nothing is near
      }
      reached = false;
      for (const Proximity& x : found_) {
        const Vec3 v = motion.head<3>() + motion.tail<3>().cross(at.pose.q * x.local) - mesh.free_at(x.triangle, x.bary);
        reached = reached || (x.gap <= 0.1 * alarm && x.normal.dot(v) < 0);
      }
      if (reached || t >= horizon) break;
      // How long nothing can be met.
      double next = horizon, fastest = 0;
      for (const Candidate& k : candidates_) {
        if (!(k.speed > 0)) continue;
        fastest = std::max(fastest, k.speed);
        next = std::min(next, k.time + std::max(0.0, k.clear) / k.speed);
      }
      if (fastest > 0) next = std::max(next, t + 0.5 * alarm / fastest);
      t = std::min(horizon, next);
    }
    if (reached && t <= 1 && (touching_piece_ < 0 || t < touch_time_)) {
      touch_time_ = t;
      touching_piece_ = index;
    }
    const auto on_free_side = [&](const Proximity& x) { return x.start_gap >= -0.05 * alarm; };
    if (t > 0)
      for (const Proximity& x : found_)
        if (on_free_side(x)) add(x);

    // Slide along what is touched (out of it, if behind) by the motion that is left. Where that leads to is known if the end is.
    if (at_end || !reached || t >= 1 || found_.empty()) continue;
    const Proximity* touched = &found_[0];
    for (const Proximity& x : found_)
      if (x.gap < touched->gap) touched = &x;
    Vec3 slide = (1 - t) * (velocity - mesh.free_at(touched->triangle, touched->bary));
    for (int pass = 0; pass < 3; ++pass)
      for (const Proximity& x : found_) {
        const double c = x.normal.dot(slide) + std::max(-settings.max_recovery, x.gap);
        if (c < 0) slide -= c * x.normal;
      }
    for (int attempt = 0; attempt < 3 && slide.norm() > 0.25 * alarm; ++attempt, slide *= 0.5) {
      found_.clear();
      evaluate(mesh, Placed(piece, index, start, motion, t, slide, settings.offset), settings, alarm, found_);
      double least = 0;
      for (const Proximity& x : found_) least = std::min(least, x.gap);
      if (least < -0.5 * alarm) continue;
      for (const Proximity& x : found_)
        if (on_free_side(x)) add(x);
      break;
    }
  }
}

}  // namespace insula
