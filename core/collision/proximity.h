// SPDX-License-Identifier: GPL-3.0-or-later
// What collision detection finds, as plain data: a point where two shapes are, or come within the step, closer than the
// alarm distance. Shape a is pushed along +normal, shape b along -normal. Scene frame, m.
#pragma once
#include <cstdint>

#include "core/base/math.h"

namespace insula {

struct Proximity {
  int piece = -1;            ///< convex piece of tool a; -1 when a is a surface
  int vertex = -1;           ///< vertex of surface a; with a tool a, the wall's vertex or point within an edge that
                             ///< identifies the contact (vertex_collider.h); -1: none
  int other_piece = -1;      ///< convex piece of tool b; -1 when b is a surface
  int side = 0;              ///< surface pairs: 0 if the vertex is of the first surface of the pair, 1 if of the second
  int triangle = -1;         ///< of surface b
  Vec3 bary = Vec3::Zero();  ///< of the point in that triangle
  Vec3 normal = Vec3::UnitZ();      ///< unit, from b to a
  Vec3 point = Vec3::Zero();        ///< on b, at the moment for which the geometry was taken
  Vec3 local = Vec3::Zero();        ///< tool frame of a: the tool's material point that is at `point` at that moment
  Vec3 other_local = Vec3::Zero();  ///< the same in the frame of tool b
  double gap = 0;                   ///< at that moment; negative when the shapes overlap
  double start_gap =
      0;  ///< of the same two material points along the same normal at the start of the step: the violation of the row
  double time = 0;              ///< that moment: 0 start, 1 end of the free motion
  std::uint64_t key = 0;        ///< stable from step to step while the contact lasts; given by ContactSelection
  Vec3 tangent = Vec3::Zero();  ///< unit, perpendicular to the normal, rotated as little as possible; also given by
                                ///< ContactSelection
};

}  // namespace insula
