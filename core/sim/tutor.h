// SPDX-License-Identifier: GPL-3.0-or-later
// What the tutor of an exercise tells: the cues that were given, with what caused them, and what is near a cue now.
// Cues are found in every session, so that the same inputs give the same bits. Who shows them decides whether they are
// seen: a test shows none.
#pragma once
#include <string>
#include <vector>

#include "core/sim/exercise.h"

namespace insula {

/// A hint with what it watches, at one time.
struct HintCause {
  std::string id;            ///< of the hint
  std::string text;          ///< for the trainee
  std::string watched;       ///< channel or metric: "brain_force.left.force"
  std::string value;         ///< of it, with its unit: "160 mN"
  std::string limit;         ///< that is guarded, likewise
  double share = 0;          ///< of the way to the limit; 1: at the limit
  double warning = 1;        ///< share from which the hint holds
  bool holds = false;        ///< now
  int hand = -1;             ///< whose tool is meant: 0 left, 1 right; -1: none or both
  Vec3 away = Vec3::Zero();  ///< unit, scene frame: leads that hand away from the fault; zero: no direction is known
};

struct Cue {
  HintCause cause;  ///< when the cue was given
  double time = 0;  ///< simulated time, s
};

/// A component of an exercise that gives cues.
class GivesCues {
 public:
  virtual ~GivesCues() = default;
  /// All cues of the run, in order.
  virtual const std::vector<Cue>& cues() const = 0;
  /// The hints that are near their cue or hold, the worst first. Allocates.
  virtual std::vector<HintCause> causes() const = 0;
};

/// The tutor of an exercise; null: it has none.
inline const GivesCues* tutor_of(const Exercise& exercise) {
  for (const auto& child : exercise.children)
    if (const auto* tutor = dynamic_cast<const GivesCues*>(child.get())) return tutor;
  return nullptr;
}

}  // namespace insula
