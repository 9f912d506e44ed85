// SPDX-License-Identifier: GPL-3.0-or-later
// What constraints and contact know of a body: where its points are, how they move, and their row entries. What the
// step needs of a body that moves is in dynamic_body.h.
// Degrees of freedom come in blocks of three: a node of a soft body is one block; a rigid body has two
// (translation, rotation vector); a fixed obstacle has none.
#pragma once
#include <array>

#include "core/base/math.h"
#include "core/linalg/body_rows.h"
#include "core/registry/component.h"

namespace insula {

class Body;

/// A point that moves with a body.
struct MaterialPoint {
  Body* body = nullptr;
  int count = 0;                   ///< nodes used (deformable bodies), 0 for rigid and fixed bodies
  int link = 0;                    ///< rigid bodies: which link
  std::array<int, 4> node{};       ///< node indices
  std::array<double, 4> weight{};  ///< sum 1
  Vec3 local = Vec3::Zero();       ///< frame of the link (rigid), scene frame (fixed), m; deformable: a constant
                                   ///< offset added to the weighted nodes, scene frame
};

class Body : public Component {
 public:
  static constexpr std::string_view kind_name = "body";

  int index = -1;  ///< position among the simulation's bodies
  BodyRows rows;   ///< rebuilt every step

  int blocks() const { return blocks_; }  ///< number of 3-blocks of degrees of freedom; 0: it never moves
  /// Position at the start of the step (current q), scene frame.
  virtual Vec3 position(const MaterialPoint& p) const = 0;
  /// Displacement over the step that collision expects, scene frame, m. For tools it is that of the free motion. For
  /// tissue it is the last step's displacement, since held tissue springs back in its free motion at every step.
  virtual Vec3 expected_displacement(const MaterialPoint& p) const = 0;
  /// Displacement over the step without constraint forces, linearised, scene frame, m. Valid after free_motion().
  /// Tissue solves for it at the first call in a step. Two threads must not call it at once.
  virtual Vec3 unforced_displacement(const MaterialPoint& p) const { return expected_displacement(p); }
  /// Whether the point can move. A fixed node cannot.
  virtual bool can_move(const MaterialPoint&) const { return blocks_ > 0; }
  /// The point's row entries for a direction d: adds d . d(point)/d(q) to the open row.
  virtual void add_row(BodyRows& rows, const MaterialPoint& p, const Vec3& d) const = 0;
  /// Retardation time at the point: viscous over elastic modulus, s. Valid after the first free motion.
  virtual double retardation_time(const MaterialPoint&) const { return 0; }

 protected:
  explicit Body(int blocks) : blocks_(blocks) {}
  void set_blocks(int blocks) { blocks_ = blocks; }

 private:
  int blocks_;
};

}  // namespace insula
