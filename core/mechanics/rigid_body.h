// SPDX-License-Identifier: GPL-3.0-or-later
// A rigid thing that is no obstacle: a hand-held tool, an implant. It has one or more links, each a set of convex
// pieces that moves as one; contact asks for the poses of the links and nothing else.
#pragma once
#include <string>
#include <vector>

#include "core/mechanics/dynamic_body.h"
#include "core/model/tools/tool_model.h"

namespace insula {

/// Something that a list of tools tells about one.
struct BodyProperty {
  std::string name;  ///< "blade_length"
  double value = 0;  ///< SI
  std::string unit;  ///< SI symbol
  std::string text;  ///< for people: "9 mm"
};

class RigidBody : public DynamicBody {
 public:
  using DynamicBody::DynamicBody;

  /// What lists of tools show of it, and words by which they sort it ("temporary").
  virtual std::vector<BodyProperty> properties() const { return {}; }
  virtual std::vector<std::string> tags() const { return {}; }
  /// What holds it now; null: nothing does.
  virtual const RigidBody* held_by() const { return nullptr; }
  /// Its shape in links, its picture, its masses.
  virtual const ToolModel& tool() const = 0;
  /// Angle of its hinges now, rad; 0 when it has none.
  virtual double opening() const { return 0; }
  virtual int links() const { return 1; }
  /// Whether it is left in the field when the tool that grasps it lets go, and closes on tissue there.
  virtual bool implant() const { return false; }
  /// Convex pieces of a link, in the link's frame.
  virtual const std::vector<ConvexPiece>& link_pieces(int link) const = 0;
  virtual Pose link_pose(int link) const = 0;       ///< at the start of the step, scene frame
  virtual Pose link_free_pose(int link) const = 0;  ///< at the end of the free motion
  /// Displacement that the free motion gives the point over the step, linearised, scene frame. Valid after
  /// free_motion().
  virtual Vec3 free_displacement(const MaterialPoint& p) const = 0;
  Vec3 expected_displacement(const MaterialPoint& p) const override { return free_displacement(p); }
  /// Puts it somewhere at once; velocity and history stay (tests, replays).
  virtual void place(const Pose& pose, double opening) = 0;
  /// The material point of a link given in the link's frame.
  MaterialPoint link_point(int link, const Vec3& local) const {
    MaterialPoint p;
    p.body = const_cast<RigidBody*>(this);
    p.link = link;
    p.local = local;
    return p;
  }
};

}  // namespace insula
