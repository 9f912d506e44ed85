// SPDX-License-Identifier: GPL-3.0-or-later
// A rigid body that moves: a hand-held tool, an implant. It has one or more links. Each link is a set of convex pieces
// that move together. Contact uses only the poses of the links.
#pragma once
#include <string>
#include <vector>

#include "core/mechanics/dynamic_body.h"
#include "core/model/tools/tool_model.h"

namespace insula {

/// A property that lists of tools show.
struct BodyProperty {
  std::string name;  ///< "blade_length"
  double value = 0;  ///< SI
  std::string unit;  ///< SI symbol
  std::string text;  ///< as shown: "9 mm"
};

class RigidBody : public DynamicBody {
 public:
  using DynamicBody::DynamicBody;

  /// Properties that lists of tools show, and words by which they sort tools ("temporary").
  virtual std::vector<BodyProperty> properties() const { return {}; }
  virtual std::vector<std::string> tags() const { return {}; }
  /// The body that holds it now; null: none.
  virtual const RigidBody* held_by() const { return nullptr; }
  /// Its shape in links, its drawn parts and its masses.
  virtual const ToolModel& tool() const = 0;
  /// Angle of its hinges now, rad; 0 when it has none.
  virtual double opening() const { return 0; }
  virtual int links() const { return 1; }
  /// Whether it stays in the field, closed on tissue, when the tool that grasps it lets go.
  virtual bool implant() const { return false; }
  /// Convex pieces of a link, in the link's frame.
  virtual const std::vector<ConvexPiece>& link_pieces(int link) const = 0;
  virtual Pose link_pose(int link) const = 0;       ///< at the start of the step, scene frame
  virtual Pose link_free_pose(int link) const = 0;  ///< at the end of the free motion
  /// Linearised displacement of the point in the free motion of the step, scene frame, m. Valid after free_motion().
  virtual Vec3 free_displacement(const MaterialPoint& p) const = 0;
  Vec3 expected_displacement(const MaterialPoint& p) const override { return free_displacement(p); }
  /// Moves it to a pose at once. Velocity and history stay (for tests and replays).
  virtual void place(const Pose& pose, double opening) = 0;
  /// A material point of a link, given in the link's frame.
  MaterialPoint link_point(int link, const Vec3& local) const {
    MaterialPoint p;
    p.body = const_cast<RigidBody*>(this);
    p.link = link;
    p.local = local;
    return p;
  }
};

}  // namespace insula
