// SPDX-License-Identifier: GPL-3.0-or-later
// Limit of a tool's motion at a wall or in tissue in one step.
#include "core/collision/shapes/closest.h"
#include "plugins/contact/contact.h"

namespace insula {
namespace {
constexpr double servo_step_s = 1e-3;  // clients with such short steps get the same limit in each of them
}

// Tissue responds linearly over a step, but its true motion is nonlinear. A large push would invert a thin wall or the
// elements of a lobe, and a large slide would leave the region of the detected contacts. So a tool in contact moves by
// at most max_step_displacement (a wall) or tissue_max_step_displacement. Three rows limit the free motion of three
// points of the touching piece.
void Contact::limit_motion(ConstraintBuilder& builder, const Pair& p) const {
  if (!p.tool_a || !p.b || !p.active() || p.b->body().blocks() == 0) return;
  const double most = p.b->thickness() > 0 ? max_step_displacement() : tissue_max_step_displacement();
  int piece = -1;
  double touch = 1;
  if (p.tool_collider) {
    piece = p.tool_collider->touching_piece();
    touch = p.tool_collider->touch_time();
  } else {
    // A contact found in the free motion, or a closed one that continues to close.
    for (const Proximity& x : p.contacts) {
      if (x.time == 0) {
        if (x.gap > 0.1 * alarm()) continue;
        const Vec3 u = p.tool_a->free_displacement(p.tool_a->link_point(p.link_a, x.local));
        if (x.normal.dot(u - p.b->collision().free_at(x.triangle, x.bary)) >= 0) continue;
      }
      if (x.time < touch) {
        touch = x.time;
        piece = x.piece;
      }
    }
  }
  if (piece < 0) return;
  const RoundedPiece& r = p.pieces_a[std::size_t(piece)];
  Vec3 third = r.core.front();
  double farthest = -1;
  for (const Vec3& q : r.core) {
    const double s = closest_on_segment(q, r.axis0, r.axis1), d = (r.axis0 + s * (r.axis1 - r.axis0) - q).norm();
    if (d > farthest) {
      farthest = d;
      third = q;
    }
  }
  int count = 0;
  for (const Vec3& place : {r.axis0, r.axis1, third}) {
    const MaterialPoint point = p.tool_a->link_point(p.link_a, place);
    const Vec3 u = p.tool_a->free_displacement(point);
    const double distance = u.norm(), allowed = touch * distance + most;
    ++count;
    if (distance <= allowed) continue;
    Block block;
    block.id = row_id(*this, std::uint64_t(1) << 43 | std::uint64_t(&p - pairs_.data()) << 16 |
                                 std::uint64_t(piece) << 2 | std::uint64_t(count));
    block.role = BlockRole::stop;
    block.lower = 0;
    const int row = builder.add(block);
    builder.violation(row, allowed);
    builder.moves(row, most / servo_step_s);
    builder.point(row, point, -u / distance);
  }
}

}  // namespace insula
