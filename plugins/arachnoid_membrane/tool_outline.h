// SPDX-License-Identifier: GPL-3.0-or-later
// The working end of a tool as balls and as points of its cutting edges, for thin things that it presses and cuts.
#pragma once
#include <vector>

#include "core/mechanics/instrument.h"

namespace insula {

class ToolOutline {
 public:
  /// A ball of the tool's shape.
  struct Ball {
    Vec3 local = Vec3::Zero();  ///< tool frame
    double radius = 0;
    Vec3 at = Vec3::Zero();  ///< scene frame
  };

  /// Some neighbouring balls: none is larger, and no centre is farther from the group's middle than `spread`.
  struct Group {
    std::size_t begin = 0, end = 0;
    double radius = 0, spread = 0;
    Vec3 local = Vec3::Zero(), at = Vec3::Zero();  ///< the middle, tool frame and scene frame
  };

  /// Balls of all pieces no farther than `length` from the tip. No place of a piece's axis is farther than half of
  /// `spacing` from one. Points of edges likewise.
  ToolOutline(Instrument& tool, double length, double spacing);

  Instrument& tool() const { return *tool_; }
  /// Follows the tool's present pose. It allocates nothing.
  void place();
  const std::vector<Ball>& balls() const { return balls_; }
  const std::vector<Group>& groups() const { return groups_; }
  /// Points along the cutting edges, in their order, each with radius 0.
  const std::vector<Ball>& edge() const { return edge_; }
  /// A ball around all of them, scene frame.
  const Vec3& middle() const { return middle_; }
  double radius() const { return radius_; }

 private:
  void add(std::vector<Ball>& to, const Vec3& local, double radius, double apart) const;
  void make_groups();

  Instrument* tool_;
  double length_;
  std::vector<Ball> balls_, edge_;
  std::vector<Group> groups_;
  Vec3 middle_ = Vec3::Zero();
  double radius_ = 0;
};

}  // namespace insula
