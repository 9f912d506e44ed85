// SPDX-License-Identifier: GPL-3.0-or-later
// One friction force for contacts that lie close together on a blade.
//
// A patch is what falls into one cell of a grid on the tool and faces one way: it does not depend on how contacts come and go.
// Its slip is the mean slip of its contacts, weighted by the force that each bore in the step before it took hold; its friction is spread
// over them by the same weights, so that it does work on its slip alone, and is bounded by mu times all they bear.
//
// A patch that sticks adds up the mean slip that the steps' linearisation lets pass, and takes it back; and it keeps its contacts and
// their weights, whatever they bear meanwhile: a mean whose weights follow the pulse would let each contact go a little further in every beat.
// Without either, a clip on a pulsing neck walks off by a micrometre a beat.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/collision/contact_set.h"
#include "core/mechanics/constraint.h"

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
    bool stays;           ///< its patch held in the last step, and it with it
  };
  struct Patch {
    std::uint32_t name;
    int first, count;  ///< of members()
    Vec3 tangent[2];   ///< scene frame, unit
    Vec3 crept;        ///< mean slip of the tool on the surface since it took hold, the tool's frame, m
    int row = -1;      ///< of its first tangent
  };
  /// Sorts contacts into patches. `tool`: pose of the frame of Proximity::local. Does not allocate.
  void sort(std::span<const Proximity> contacts, const Pose& tool);
  std::vector<Member>& members() { return members_; }
  std::vector<Patch>& patches() { return patches_; }
  /// Force of each contact along (normal, tangent, other tangent) of its own, N; remembers what each bore and how far its patch has crept.
  void finish(std::span<const Proximity> contacts, const ConstraintSolution& solution, double friction, std::vector<Vec3>& forces);
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
    Vec3 crept;         ///< the tool's frame, m
    Vec3 slip;          ///< of its contacts since then, by weight
    double weight = 0;  ///< of those that are still there
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
