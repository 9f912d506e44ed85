// SPDX-License-Identifier: GPL-3.0-or-later
// One friction force for contacts that lie close together on a blade.
//
// A patch is what falls into one cell of a grid on the tool and faces one way: it does not depend on how contacts come and go.
// Its slip is the mean slip of its contacts, weighted by the force that each bore in the last step; its friction is spread
// over them by the same weights, so that it does work on its slip alone, and is bounded by mu times all they bear.
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/collision/contact_set.h"
#include "core/constraint/constraint.h"

namespace insula {

class FrictionPatches {
 public:
  /// `size` of a patch, m; at most `room` contacts.
  FrictionPatches(double size, std::size_t room);

  struct Member {
    std::uint32_t patch;  ///< name of its patch
    int contact;          ///< index
    double weight;        ///< of its slip in that of the patch; those of a patch sum to one
    int row;              ///< of its normal
  };
  struct Patch {
    std::uint32_t name;
    int first, count;  ///< of members()
    Vec3 tangent[2];   ///< scene frame, unit
    int row = -1;      ///< of its first tangent
  };
  /// Sorts contacts into patches. `tool`: pose of the frame of Proximity::local. Does not allocate.
  void sort(std::span<const Proximity> contacts, const Pose& tool);
  std::vector<Member>& members() { return members_; }
  std::vector<Patch>& patches() { return patches_; }
  /// Force of each contact along (normal, tangent, other tangent) of its own, N; remembers what each bore.
  void finish(std::span<const Proximity> contacts, const ConstraintSolution& solution, std::vector<Vec3>& forces);
  void reset();

 private:
  double bore(std::uint64_t key) const;

  double size_;
  std::vector<Member> members_;
  std::vector<Patch> patches_;
  std::vector<std::pair<std::uint64_t, double>> bore_;  ///< by key: normal force in the last step, N
};

}  // namespace insula
