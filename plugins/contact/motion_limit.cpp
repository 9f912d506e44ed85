// SPDX-License-Identifier: GPL-3.0-or-later
// Limit of a tool's motion at a wall or in tissue in one step.
#include <algorithm>

#include "core/collision/shapes/closest.h"
#include "plugins/contact/contact.h"

namespace insula {
namespace {
// Lengths over the limit of the motion inward.
constexpr double farthest_along = 3;   // of the motion along what is touched
constexpr double shallow = 2;          // of an overlap at the end of the motion that a wall bears without inverting
constexpr double fast = 10;            // of a motion that may meet what no contact was found with
constexpr double servo_step_s = 1e-3;  // clients with such short steps get the same limit in each of them

Vec3 farthest_from_axis(const RoundedPiece& r) {
  Vec3 out = r.core.front();
  double farthest = -1;
  for (const Vec3& q : r.core) {
    const double s = closest_on_segment(q, r.axis0, r.axis1), d = (r.axis0 + s * (r.axis1 - r.axis0) - q).norm();
    if (d <= farthest) continue;
    farthest = d;
    out = q;
  }
  return out;
}

}  // namespace

// Tissue responds linearly over a step, but its true motion is nonlinear. A large push would invert a thin wall or the
// elements of a lobe, and a large slide would leave the region of the detected contacts. So a tool goes into what it
// touches by at most max_step_displacement (a wall) or tissue_max_step_displacement. A tool in a hand moves along a
// wall by up to three times as much, since the hand would be held back. Three rows limit the free motion of three
// points of the touching piece. A motion that no contact opposes is free, so a hand that leaves is never pulled. So is
// one that ends in a shallow overlap with a wall, such as a quick tap or a quick stroke along it.
void Contact::limit_motion(ConstraintBuilder& builder, const Pair& p) const {
  if (!p.tool_a || !p.b || !p.active() || p.b->body().blocks() == 0) return;
  const bool wall = p.b->thickness() > 0;
  const double deepest = wall ? max_step_displacement() : tissue_max_step_displacement();
  const double along = wall && p.in_hand ? farthest_along : 1;
  const Touch touch = first_touch(p);
  if (touch.piece < 0) return;
  const bool ends_near = wall && p.in_hand && touch.overlap_at_end <= shallow * deepest;
  const RoundedPiece& r = p.pieces_a[std::size_t(touch.piece)];
  int count = 0;
  for (const Vec3& place : {r.axis0, r.axis1, farthest_from_axis(r)}) {
    const MaterialPoint point = p.tool_a->link_point(p.link_a, place);
    const Vec3 u = p.tool_a->free_displacement(point);
    const double distance = u.norm();
    double inward = 0;
    for (const Vec3& n : touch.normals()) inward = std::max(inward, -n.dot(u));
    ++count;
    if (inward <= 0) continue;
    if (ends_near && (1 - touch.time) * inward <= farthest_along * deepest) continue;
    const double ratio = distance < fast * deepest ? std::min(distance / inward, along) : 1;
    const double most = ratio * deepest, allowed = touch.time * distance + most;
    if (distance <= allowed) continue;
    Block block;
    block.id = row_id(*this, std::uint64_t(1) << 43 | std::uint64_t(&p - pairs_.data()) << 16 |
                                 std::uint64_t(touch.piece) << 2 | std::uint64_t(count));
    block.role = BlockRole::stop;
    block.lower = 0;
    const int row = builder.add(block);
    builder.violation(row, allowed);
    builder.moves(row, most / servo_step_s);
    builder.point(row, point, -u / distance);
  }
}

/// The first touch of the tool in the step: found in the free motion, or of a closed contact that continues to close.
Contact::Touch Contact::first_touch(const Pair& p) const {
  Touch touch;
  if (p.tool_collider) {
    touch.piece = p.tool_collider->touching_piece();
    touch.time = p.tool_collider->touch_time();
    touch.overlap_at_end = p.tool_collider->overlap_at_end();
    for (const Vec3& n : p.tool_collider->touch_normals()) touch.add(n);
    return touch;
  }
  const auto closed = [&](const Proximity& x) { return x.time > 0 || x.gap <= 0.1 * alarm(); };
  for (const Proximity& x : p.contacts) {
    if (!closed(x)) continue;
    if (x.time == 0) {
      const Vec3 u = p.tool_a->free_displacement(p.tool_a->link_point(p.link_a, x.local));
      if (x.normal.dot(u - p.b->collision().free_at(x.triangle, x.bary)) >= 0) continue;
    }
    if (x.time < touch.time) {
      touch.piece = x.piece;
      touch.time = x.time;
    }
  }
  for (const Proximity& x : p.contacts)
    if (x.piece == touch.piece && closed(x) && x.time <= touch.time) touch.add(x.normal);
  return touch;
}

}  // namespace insula
