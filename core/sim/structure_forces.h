// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of the hands on tissue, floor and bone in a step.
//
// A hand acts through its tool and through every body that the tool holds, such as a clip in an applier. The force on
// a structure that moves is that of all rows of the step's problem between it and those bodies. It includes contact,
// friction and the grip of suction. The force on a structure that never moves is that of the contacts, since such a
// structure has no rows.
#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "core/base/math.h"
#include "core/constraint/problem.h"

namespace insula {

class Body;
class Instrument;
class RigidBody;
struct ContactPoint;

/// Resultant forces of the two hands on one structure, scene frame, N. A structure is a body that is not rigid: tissue,
/// a vessel, an obstacle.
struct StructureForce {
  const Body* body = nullptr;
  std::array<Vec3, 2> of_hand{Vec3::Zero(), Vec3::Zero()};  ///< left, right
  /// Norm of the larger one, N.
  double largest() const { return std::max(of_hand[0].norm(), of_hand[1].norm()); }
};

class StructureForces {
 public:
  /// Called once. The structures are listed in the order of `bodies`.
  explicit StructureForces(const std::vector<Body*>& bodies);
  /// All structures, with zero forces.
  const std::vector<StructureForce>& none() const { return none_; }
  /// Sets the forces of the step. `out` keeps its size; nothing is allocated once the problem has had its largest size.
  void read(const ConstraintProblem& problem, const std::vector<ContactPoint>& contacts,
            std::vector<StructureForce>& out);
  /// Hand that moves the body, directly or by a tool that holds it: 0 left, 1 right; -1: none.
  static int hand_of(const Body* body);

 private:
  std::vector<StructureForce> none_;
  std::vector<const RigidBody*> rigid_;
  std::vector<int> structure_of_row_;  ///< -1: none
};

}  // namespace insula
