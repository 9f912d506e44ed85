// SPDX-License-Identifier: GPL-3.0-or-later
// One friction force for neighbouring contacts on a blade.
//
// A patch has the contacts in one cell of a grid on the tool that have similar normals. This does not depend on which
// contacts appear and vanish. The slip of a patch is the mean slip of its contacts. The weights are the contacts'
// forces in the step before the patch began to stick. The friction is spread over the contacts by the same weights, so
// it does work only on the slip of the patch. It is bounded by mu times the sum of their normal forces.
//
// A sticking patch sums the mean slip that remains because of the steps' linearisation, and reverses it. It keeps its
// contacts and their weights, independent of their forces meanwhile. If the weights followed the pulse, each contact
// would move a little further in every beat. Without these two rules, a clip on a pulsing neck creeps by a micrometre
// in each beat.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/collision/proximity.h"
#include "core/mechanics/constraint.h"

namespace insula {

class FrictionPatches {
 public:
  /// `size` of a patch, m; at most `room` contacts.
  FrictionPatches(double size, std::size_t room);

  struct Member {
    std::uint32_t patch;  ///< id of its patch
    int contact;          ///< index
    double weight;        ///< of its slip in the slip of the patch; weights of a patch sum to one
    int row;              ///< of its normal row
    bool stays;           ///< the patch stuck in the last step, with this contact
  };
  struct Patch {
    std::uint32_t name;
    int first, count;  ///< of members()
    Vec3 tangent[2];   ///< scene frame, unit
    Vec3 crept;        ///< mean slip of the tool on the surface since the patch began to stick, tool frame, m
    int row = -1;      ///< its first tangent row
  };
  /// Sorts contacts into patches. `tool`: pose of the frame of Proximity::local. Does not allocate.
  void sort(std::span<const Proximity> contacts, const Pose& tool);
  std::vector<Member>& members() { return members_; }
  std::vector<Patch>& patches() { return patches_; }
  /// Force of each contact along its own (normal, tangent, other tangent), N. Stores the normal forces and the creep of
  /// each patch.
  void finish(std::span<const Proximity> contacts, const ConstraintSolution& solution, double friction,
              std::vector<Vec3>& forces);
  void reset();

 private:
  /// A contact of the last step.
  struct Known {
    std::uint64_t key;
    double bore;    ///< normal force, N
    double weight;  ///< in its patch
    Vec3 local;
    std::uint32_t patch;
  };
  /// A patch of the last step.
  struct Held {
    std::uint32_t name;
    bool holds;
    Vec3 crept;         ///< tool frame, m
    Vec3 slip;          ///< of its contacts since then, weighted
    double weight = 0;  ///< of the contacts that still exist
  };
  const Known* known(std::uint64_t key) const;
  Held* held(std::uint32_t name);

  double size_;
  std::vector<Member> members_;
  std::vector<Patch> patches_;
  std::vector<Known> known_;  ///< by key
  std::vector<Held> held_;    ///< by name
};

}  // namespace insula
